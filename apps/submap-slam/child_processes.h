#pragma once

#include <submap_slam/pipeline/reporter.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace submap_slam {

/** Work that runs in a process of its own, so that its time and memory are its own and a crash ends nothing
 * else. */
struct ChildTask {
  std::string name;
  std::filesystem::path folder;  ///< gets output.txt with all that the task prints; error.txt if it fails
  std::function<void()> run;     ///< fails by throwing, or by ending the process
};

constexpr const char* kErrorFile = "error.txt";

/** Runs the tasks, up to `jobs` at a time, in their order, and reports each one's end. Failed tasks do not
 * stop the others. After a stop signal the running ones are stopped too and false is returned. Must be called
 * before the process has started threads. */
bool runInChildProcesses(const std::vector<ChildTask>& tasks, int jobs, Reporter& reporter);

}  // namespace submap_slam
