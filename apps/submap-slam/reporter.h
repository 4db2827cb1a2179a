#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace submap_slam {

/** What a run tells its user: progress and warnings on stderr, and the lines that are kept for log.txt.
 *
 * The kept lines hold no times and no paths of results, so log.txt is the same for equal runs. Not
 * thread-safe.
 */
class Reporter {
 public:
  /** @param quiet no progress (warnings are still shown) */
  explicit Reporter(bool quiet);
  ~Reporter();
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;

  /** Shows how far a stage is: one line that is rewritten on a terminal, else a line about every 10 %.
   * @param fraction share of the stage that is done, [0, 1]; the time left is estimated from it
   * @param units    how much of it was done in all, shown as units per second; 0: not shown */
  void progress(const std::string& stage, double fraction, std::size_t units = 0,
                const std::string& unit = "");

  /** Keeps a line for log.txt. */
  void log(const std::string& line);

  /** Shows a warning and keeps it. */
  void warning(const std::string& line);

  /** Shows a line unless quiet; not kept. */
  void note(const std::string& line);

  const std::vector<std::string>& logLines() const { return log_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  using Clock = std::chrono::steady_clock;

  void startStage(const std::string& stage, double fraction);
  void endProgressLine();

  bool quiet_, terminal_;
  std::vector<std::string> log_, warnings_;

  std::string stage_;
  Clock::time_point stage_start_, last_shown_;
  double start_fraction_ = 0;
  int tenths_shown_ = 0;
  bool line_open_ = false;
};

}  // namespace submap_slam
