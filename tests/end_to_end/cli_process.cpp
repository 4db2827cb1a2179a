#include "cli_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace submap_slam::testing {
namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(opened, descriptor);
}

}  // namespace

Process::Process(const std::string& program, const Arguments& arguments, const std::filesystem::path& folder)
    : out_(folder / "stdout.txt"), err_(folder / "stderr.txt"), pid_(fork()) {
  if (pid_ != 0) return;
  redirect(STDOUT_FILENO, out_);
  redirect(STDERR_FILENO, err_);
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  _exit(127);
}

bool Process::running() {
  if (!ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return !ended_;
}

void Process::signal(int number) {
  if (running()) kill(pid_, number);
}

Outcome Process::wait() {
  if (!ended_) waitpid(pid_, &status_, 0);
  ended_ = true;
  const int code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  return {code, contentOf(out_), contentOf(err_)};
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void writeFile(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

std::map<std::string, std::string> contentsOf(const std::filesystem::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) contents[entry.path().filename().string()] = contentOf(entry.path());
  return contents;
}

std::map<std::string, std::string> reproducibleResults(const std::filesystem::path& folder) {
  auto contents = contentsOf(folder);
  EXPECT_EQ(contents.erase("metrics.json"), 1u);
  std::string& report = contents["report.html"];
  const std::size_t begin = report.find("\n\"metrics\":{");
  EXPECT_NE(begin, std::string::npos);
  report.erase(begin, report.find('\n', begin + 1) - begin);
  return contents;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace submap_slam::testing
