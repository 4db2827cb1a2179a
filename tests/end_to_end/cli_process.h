#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace submap_slam::testing {

/** What a finished program left behind. */
struct Outcome {
  int exit_code = -1;  ///< −signal if a signal ended it
  std::string out, err;
};

using Arguments = std::vector<std::string>;

/** A program that runs; its output goes to files in `folder`. */
class Process {
 public:
  Process(const std::string& program, const Arguments& arguments, const std::filesystem::path& folder);
  bool running();
  void signal(int number);
  Outcome wait();

 private:
  std::filesystem::path out_, err_;
  pid_t pid_;
  int status_ = 0;
  bool ended_ = false;
};

std::string contentOf(const std::filesystem::path& file);
void writeFile(const std::filesystem::path& file, const std::string& content);

/** Content of every regular file of a folder, by name. */
std::map<std::string, std::string> contentsOf(const std::filesystem::path& folder);

/** What a finished run wrote and must be the same bytes for equal runs: contentsOf without times, which are
 * in metrics.json and in one line of report.html. */
std::map<std::string, std::string> reproducibleResults(const std::filesystem::path& folder);

std::size_t lines(const std::string& text);

}  // namespace submap_slam::testing
