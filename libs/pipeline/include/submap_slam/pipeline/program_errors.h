/** How the programs end, and how they say why. */
#pragma once

#include <string>

namespace submap_slam {

/** Exit codes of the programs. */
enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,       ///< could not do it: disk full, out of memory, …
  kBadInput = 2,      ///< wrong option, configuration, plugin or file
  kDamagedLog = 3,    ///< the log is damaged; results of the part before the damage are written
  kInterrupted = 130  ///< Ctrl-C; what was complete is written
};

/** Says `PROGRAM: error: TEXT` in one line on stderr and returns the exit code. */
int reportError(const std::string& program, const std::string& text, ExitCode exit_code);

/** To be called where an exception was caught: says what it is as reportError does, and returns the exit code
 * of its type. Throws on what is no std::exception. */
int reportCaughtError(const std::string& program);

}  // namespace submap_slam
