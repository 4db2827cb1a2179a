#include "child_processes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <thread>

#include "stop_signal.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(10);

void writeError(const ChildTask& task, const std::string& text) {
  std::ofstream(task.folder / kErrorFile, std::ios::binary) << text << '\n';
}

void redirectOutput(const fs::path& file) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(opened, STDOUT_FILENO);
  dup2(opened, STDERR_FILENO);
}

[[noreturn]] void runAsChild(const ChildTask& task) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a killed experiment leaves nothing running
  redirectOutput(task.folder / "output.txt");
  int exit_code = EXIT_SUCCESS;
  try {
    task.run();
  } catch (const Interrupted&) {
    exit_code = EXIT_FAILURE;
  } catch (const std::exception& e) {
    writeError(task, e.what());
    exit_code = EXIT_FAILURE;
  }
  fflush(nullptr);
  _exit(exit_code);
}

pid_t start(const ChildTask& task) {
  fs::create_directories(task.folder);
  fs::remove(task.folder / kErrorFile);
  fflush(nullptr);
  const pid_t pid = fork();
  if (pid == 0) runAsChild(task);
  if (pid < 0) throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  return pid;
}

/** What to say of a task that ended with that status of waitpid. */
std::string outcome(const ChildTask& task, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == EXIT_SUCCESS) return "done";
  if (WIFSIGNALED(status) && !stopRequested())
    writeError(task, fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status))));
  std::ifstream in(task.folder / kErrorFile);
  const std::string error{std::istreambuf_iterator<char>(in), {}};
  return error.empty() ? "stopped" : "failed: " + error.substr(0, error.find('\n'));
}

}  // namespace

bool runInChildProcesses(const std::vector<ChildTask>& tasks, int jobs, Reporter& reporter) {
  std::map<pid_t, const ChildTask*> running;
  auto next = tasks.begin();
  std::size_t ended = 0;
  bool stopping = false;
  while (!running.empty() || (next != tasks.end() && !stopping)) {
    if (stopRequested() && !stopping) {
      stopping = true;
      for (const auto& [pid, task] : running) kill(pid, SIGTERM);
    }
    while (!stopping && next != tasks.end() && running.size() < static_cast<std::size_t>(jobs)) {
      const pid_t pid = start(*next);
      running.emplace(pid, &*next++);
    }
    int status = 0;
    const pid_t pid = waitpid(-1, &status, WNOHANG);
    if (pid <= 0) {
      std::this_thread::sleep_for(kPollInterval);
      continue;
    }
    const ChildTask& task = *running.at(pid);
    running.erase(pid);
    reporter.note(fmt::format("[{}/{}] {}: {}", ++ended, tasks.size(), task.name, outcome(task, status)));
  }
  return !stopping;
}

}  // namespace submap_slam
