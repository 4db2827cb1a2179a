#include "terminal_reporter.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "stop_signal.h"

namespace submap_slam {
namespace {

constexpr auto kRewriteInterval = std::chrono::milliseconds(100);

std::string minutesAndSeconds(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

TerminalReporter::TerminalReporter(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

TerminalReporter::~TerminalReporter() { endProgressLine(); }

void TerminalReporter::startStage(const std::string& stage, double fraction) {
  endProgressLine();
  stage_ = stage;
  stage_start_ = Clock::now();
  last_shown_ = {};
  start_fraction_ = fraction;
  tenths_shown_ = static_cast<int>(fraction * 10);
}

void TerminalReporter::progress(const std::string& stage, double fraction, std::size_t units,
                                const std::string& unit) {
  if (quiet_) return;
  fraction = std::clamp(fraction, 0.0, 1.0);
  if (stage != stage_) startStage(stage, fraction);

  const auto now = Clock::now();
  const int tenths = static_cast<int>(fraction * 10);
  const bool due =
      terminal_ ? now - last_shown_ >= kRewriteInterval || fraction == 1 : tenths > tenths_shown_;
  if (!due) return;
  last_shown_ = now;
  tenths_shown_ = tenths;

  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  std::string line = fmt::format("{}: {:3.0f} %", stage, 100 * fraction);
  if (units > 0 && elapsed_s > 0)
    line += fmt::format(", {:.0f} {}/s", static_cast<double>(units) / elapsed_s, unit);
  if (fraction > start_fraction_ && fraction < 1)
    line += ", " + minutesAndSeconds(elapsed_s * (1 - fraction) / (fraction - start_fraction_)) + " left";
  fmt::print(stderr, terminal_ ? "\r{}\033[K" : "{}\n", line);
  line_open_ = terminal_;
}

void TerminalReporter::endProgressLine() {
  if (line_open_) fmt::print(stderr, "\n");
  line_open_ = false;
}

bool TerminalReporter::stopRequested() const { return submap_slam::stopRequested(); }

void TerminalReporter::showWarning(const std::string& line) {
  endProgressLine();
  fmt::print(stderr, "submap-slam: warning: {}\n", line);
}

void TerminalReporter::note(const std::string& line) {
  if (quiet_) return;
  endProgressLine();
  fmt::print(stderr, "{}\n", line);
}

}  // namespace submap_slam
