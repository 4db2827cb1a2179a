#pragma once

#include <submap_slam/pipeline/reporter.h>

#include <chrono>
#include <string>

namespace submap_slam {

/** Shows progress, notes and warnings on stderr; the first Ctrl-C asks to stop. */
class TerminalReporter : public Reporter {
 public:
  /** @param quiet no progress and no notes (warnings are still shown) */
  explicit TerminalReporter(bool quiet);
  ~TerminalReporter() override;

  /** One line that is rewritten on a terminal, else a line about every 10 %, with units per second and the
   * time left as far as they can be told. */
  void progress(const std::string& stage, double fraction, std::size_t units = 0,
                const std::string& unit = "") override;

  void note(const std::string& line) override;
  bool stopRequested() const override;

 private:
  using Clock = std::chrono::steady_clock;

  void showWarning(const std::string& line) override;
  void startStage(const std::string& stage, double fraction);
  void endProgressLine();

  bool quiet_, terminal_;
  std::string stage_;
  Clock::time_point stage_start_, last_shown_;
  double start_fraction_ = 0;
  int tenths_shown_ = 0;
  bool line_open_ = false;
};

}  // namespace submap_slam
