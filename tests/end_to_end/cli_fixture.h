#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli_process.h"

namespace submap_slam::testing {

/** Runs the built program in a temporary folder of its own. */
class CliTest : public ::testing::Test {
 protected:
  CliTest() {
    std::string name = (std::filesystem::temp_directory_path() / "submap-slam-cli-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    std::filesystem::create_directory(folder_ / "output");
  }
  ~CliTest() override { std::filesystem::remove_all(folder_); }

  /** A path in the temporary folder. */
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  Process start(const Arguments& arguments) const { return {program(), arguments, folder_ / "output"}; }
  Outcome run(const Arguments& arguments) const { return start(arguments).wait(); }

  /** Runs and expects success. */
  Outcome succeed(const Arguments& arguments) const {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  }

  /** Runs any other program. */
  Outcome runOther(const std::string& other, const Arguments& arguments) const {
    return Process(other, arguments, folder_ / "output").wait();
  }

  /** One clear line of error and nothing else. */
  static void expectRefused(const Outcome& outcome, const std::string& text) {
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(lines(outcome.err), 1u) << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::StartsWith("submap-slam: error: "));
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(text));
  }

  static std::string program() { return SUBMAP_SLAM_BINARY_DIR "/bin/submap-slam"; }
  static std::string log(const std::string& name) { return SUBMAP_SLAM_SOURCE_DIR "/rawlogs/" + name; }

  /** Arguments appended: a short piece of log in short submaps, joined by their chain alone. */
  static Arguments quickly(Arguments arguments) {
    for (const char* extra :
         {"--to", "20s", "--set", "submaps.max_distance=2", "--set", "joining.chain=", "--quiet"})
      arguments.push_back(extra);
    return arguments;
  }

  std::filesystem::path folder_;
};

}  // namespace submap_slam::testing
