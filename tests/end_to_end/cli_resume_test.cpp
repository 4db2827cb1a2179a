/** A run that was killed or stopped goes on where it was and ends with the same bytes. */
#include <csignal>
#include <random>
#include <thread>

#include "cli_fixture.h"

namespace submap_slam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

std::size_t sizeOf(const fs::path& file) {
  std::error_code missing;
  const auto size = fs::file_size(file, missing);
  return missing ? 0 : static_cast<std::size_t>(size);
}

/** Sends the signal as soon as the file has that size; does nothing if the process ends before. */
void signalAtSize(Process& process, const fs::path& file, std::size_t bytes, int number) {
  while (process.running() && sizeOf(file) < bytes) std::this_thread::yield();
  process.signal(number);
}

/** Whether nothing is left to do; a kill may come after that. */
bool isComplete(const std::string& submap_file) {
  return contentOf(submap_file + ".resume.json").find("\"complete\": true") != std::string::npos;
}

class ResumeTest : public CliTest {
 protected:
  Arguments build(const std::string& file) const {
    return quickly({"build", log("room.rawlog"), "-o", file});
  }
};

TEST_F(ResumeTest, KilledBuildsEndWithTheSameBytes) {
  succeed(build(path("whole.rawlog")));
  const std::string whole = contentOf(path("whole.rawlog"));
  std::mt19937 random(5);
  for (int round = 0; round < 3; ++round) {
    const std::string file = path("killed" + std::to_string(round) + ".rawlog");
    std::size_t kills = 0;
    for (const double share : {0.0, 0.2, 0.6}) {
      Process process = start(build(file));
      const double jitter = 0.3 * static_cast<double>(random()) / 4294967296.0;
      signalAtSize(process, file,
                   static_cast<std::size_t>((share + jitter) * static_cast<double>(whole.size())), SIGKILL);
      kills += process.wait().exit_code == -SIGKILL;
    }
    if (!isComplete(file)) succeed(build(file));
    EXPECT_GT(kills, 0u) << "no run was killed in time; the test shows nothing";
    EXPECT_TRUE(contentOf(file) == whole) << "round " << round;
  }
}

TEST_F(ResumeTest, KilledMapEndsWithTheSameBytes) {
  const Arguments whole = quickly({"map", log("room.rawlog"), "-o", path("whole")});
  const Arguments killed = quickly({"map", log("room.rawlog"), "-o", path("killed")});
  succeed(whole);
  Process process = start(killed);
  signalAtSize(process, path("killed/submaps.rawlog"), 1, SIGKILL);
  ASSERT_EQ(process.wait().exit_code, -SIGKILL);
  succeed(killed);

  EXPECT_TRUE(reproducibleResults(path("whole")) == reproducibleResults(path("killed")));
}

TEST_F(ResumeTest, StopSignalLeavesAValidFileToGoOnFrom) {
  succeed(build(path("whole.rawlog")));
  for (const int number : {SIGINT, SIGTERM}) {
    const std::string file = path("stopped" + std::to_string(number) + ".rawlog");
    Arguments arguments = build(file);
    arguments.insert(arguments.end(), {"--threads", "1"});
    Process process = start(arguments);
    signalAtSize(process, file, 1, number);
    ASSERT_EQ(process.wait().exit_code, 130);
    EXPECT_LT(sizeOf(file), sizeOf(path("whole.rawlog")));
    succeed({"info", file});
    succeed(arguments);
    EXPECT_TRUE(contentOf(file) == contentOf(path("whole.rawlog")));
  }
}

TEST_F(ResumeTest, StoppedMapSaysHowToGoOn) {
  Arguments arguments{"map",   log("room.rawlog"),       "-o",        path("out"),
                      "--set", "submaps.max_distance=2", "--threads", "1"};
  Process process = start(arguments);
  signalAtSize(process, path("out/submaps.rawlog"), 1, SIGINT);
  const Outcome outcome = process.wait();
  ASSERT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("submap-slam join " + path("out/submaps.rawlog")));
  EXPECT_FALSE(fs::exists(path("out/metrics.json")));
}

TEST_F(ResumeTest, ASecondStopSignalEndsAtOnce) {
  Arguments arguments{"build", log("room.rawlog"), "-o", path("s.rawlog"), "--set", "submaps.max_distance=2"};
  Process process = start(arguments);
  signalAtSize(process, path("s.rawlog"), 1, SIGSTOP);
  process.signal(SIGINT);
  process.signal(SIGTERM);
  process.signal(SIGCONT);
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, Not(HasSubstr("give the same command again"))) << "it ended in its own time";
  succeed(arguments);  // even if the very first submap was half written
  succeed({"info", path("s.rawlog")});
}

TEST_F(ResumeTest, AStopSignalDuringWritingChangesNothing) {
  Process process = start(quickly({"map", log("room.rawlog"), "-o", path("out")}));
  signalAtSize(process, path("out/map.png"), 1, SIGINT);
  EXPECT_EQ(process.wait().exit_code, 0);
  EXPECT_TRUE(fs::exists(path("out/metrics.json")));
}

TEST_F(ResumeTest, TwoRunsNeverWriteOneFile) {
  succeed(build(path("whole.rawlog")));
  const std::string file = path("s.rawlog");
  Process first = start(build(file));
  signalAtSize(first, file, 1, SIGSTOP);
  const std::string before = contentOf(file);
  for (const char* option : {"--threads=1", "--overwrite"}) {
    Arguments again = build(file);
    again.push_back(option);
    fs::create_directory(path(option));
    const Outcome second = Process(program(), again, path(option)).wait();
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_EQ(second.err, "submap-slam: error: " + file + ": another run is writing it\n");
    EXPECT_TRUE(contentOf(file) == before);
  }
  first.signal(SIGCONT);
  EXPECT_EQ(first.wait().exit_code, 0);
  EXPECT_TRUE(contentOf(file) == contentOf(path("whole.rawlog")));
}

TEST_F(ResumeTest, FinishedFileNeedsOverwrite) {
  succeed(build(path("s.rawlog")));
  const std::string before = contentOf(path("s.rawlog"));
  expectRefused(run(build(path("s.rawlog"))), "--overwrite");
  EXPECT_TRUE(contentOf(path("s.rawlog")) == before);
  Arguments again = build(path("s.rawlog"));
  again.push_back("--overwrite");
  succeed(again);
  EXPECT_TRUE(contentOf(path("s.rawlog")) == before);
}

TEST_F(ResumeTest, AnotherRunIsNotContinued) {
  Arguments arguments = build(path("s.rawlog"));
  Process process = start(arguments);
  signalAtSize(process, path("s.rawlog"), 1, SIGKILL);
  ASSERT_EQ(process.wait().exit_code, -SIGKILL);
  const std::string before = contentOf(path("s.rawlog"));

  arguments.insert(arguments.end(), {"--seed", "99"});
  expectRefused(run(arguments), "other parameters");
  expectRefused(run(quickly({"build", log("loop.rawlog"), "-o", path("s.rawlog")})), "log");
  EXPECT_TRUE(contentOf(path("s.rawlog")) == before);
}

TEST_F(ResumeTest, ALogEditedInPlaceIsAnotherLog) {
  fs::copy_file(log("room.rawlog"), path("log.rawlog"));
  const Arguments arguments = quickly({"build", path("log.rawlog"), "-o", path("s.rawlog")});
  Process process = start(arguments);
  signalAtSize(process, path("s.rawlog"), 1, SIGKILL);
  ASSERT_EQ(process.wait().exit_code, -SIGKILL);
  std::string edited = contentOf(path("log.rawlog"));
  edited.back() = static_cast<char>(edited.back() ^ 1);
  writeFile(path("log.rawlog"), edited);
  expectRefused(run(arguments), "a log of other content");
}

}  // namespace
}  // namespace submap_slam::testing
