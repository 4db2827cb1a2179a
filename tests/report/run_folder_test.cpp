#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/report/run_folder.h>

#include "sample_run.h"

namespace submap_slam {
namespace {

using ::testing::HasSubstr;

class RunFolderTest : public ::testing::Test {
 protected:
  std::string run() const {
    return writeRun(folder, "run", sampleTrajectory(), R"({"submaps": 2})", "[run]\nseed = 1\n");
  }

  static void expectRefused(const std::string& path, const std::string& text) {
    try {
      readRunFolder(path);
      FAIL() << "was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(text));
      EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
    }
  }

  TempFolder folder;
};

TEST_F(RunFolderTest, ReadsWhatARunWrote) {
  const RunFolder read = readRunFolder(run());
  EXPECT_EQ(read.name, "run");
  EXPECT_EQ(read.metrics["submaps"], 2);
  EXPECT_EQ(read.settings.back().value, "1");
  EXPECT_EQ(read.trajectory.poses().size(), 3u);
  ASSERT_TRUE(read.map);
  EXPECT_EQ(read.map->getSizeX(), 4u);
  EXPECT_TRUE(read.landmarks.empty());
}

TEST_F(RunFolderTest, NameDoesNotDependOnASlash) { EXPECT_EQ(readRunFolder(run() + "/").name, "run"); }

TEST_F(RunFolderTest, ReadsLandmarks) {
  run();
  folder.write("run/landmarks.csv", "id,x,y,sxx,sxy,syy,hits\n3,1.5,-2,1,0,1,4\n");
  const RunFolder read = readRunFolder(folder.file("run"));
  ASSERT_EQ(read.landmarks.size(), 1u);
  EXPECT_EQ(read.landmarks[0].x, 1.5);
  EXPECT_EQ(read.landmarks[0].y, -2);
  folder.write("run/landmarks.csv", "id,x,y\nthree\n");
  expectRefused(folder.file("run"), "landmarks.csv:1: expected the head id,x,y");
}

TEST_F(RunFolderTest, WhatIsNoRunIsRefused) {
  expectRefused(folder.file("nothing"), "nothing: no such folder");
  expectRefused(folder.write("file", ""), "file: is no folder");
  std::filesystem::create_directory(folder.file("empty"));
  expectRefused(folder.file("empty"), "empty: holds no finished run");
}

TEST_F(RunFolderTest, DamagedFilesAreNamed) {
  run();
  folder.write("run/map.gridmap.gz", "no map");
  expectRefused(folder.file("run"), "map.gridmap.gz: cannot be read");
  folder.write("run/metrics.json", "[1, 2");
  expectRefused(folder.file("run"), "metrics.json: is no JSON object");
  run();
  std::filesystem::remove(folder.file("run/trajectory.tum"));
  expectRefused(folder.file("run"), "trajectory.tum");
}

}  // namespace
}  // namespace submap_slam
