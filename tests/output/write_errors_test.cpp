#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/landmark_files.h>
#include <submap_slam/output/map_image.h>
#include <submap_slam/output/mrpt_files.h>
#include <submap_slam/output/ros_map.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>

#include <functional>
#include <random>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

struct Writer {
  const char* name;
  std::function<void(const std::string& file)> write;
};

/** Takes more than 1 MiB before compression; its first rows cannot be compressed. */
PackedEvidence largeGrid() {
  constexpr int kSide = 1300, kRowsOfNoise = 50;
  PackedEvidence grid(0, 0.1 * kSide, 0, 0.1 * kSide, 0.1);
  std::mt19937 noise(1);
  for (int y = 0; y < kRowsOfNoise; ++y)
    for (int x = 0; x < kSide; ++x) grid.set(x, y, static_cast<float>(noise() % 7) - 3, 1);
  return grid;
}

class Writers : public testing::TestWithParam<Writer> {};

}  // namespace

TEST_P(Writers, NameTheFileInAFolderThatDoesNotExist) {
  const TempFolder folder;
  const auto file = folder.file("missing/result");
  EXPECT_THAT([&] { GetParam().write(file); }, testing::ThrowsMessage<OutputError>(testing::HasSubstr(file)));
}

TEST_P(Writers, NoticeAFullDisk) {
  const TempFolder folder;
  // Writing to it fails as on a full disk.
  std::filesystem::create_symlink("/dev/full", folder.file("result"));
  std::filesystem::create_symlink("/dev/full", folder.file("result.pgm"));
  EXPECT_THAT([&] { GetParam().write(folder.file("result")); },
              testing::ThrowsMessage<OutputError>(testing::AllOf(testing::HasSubstr(folder.file("result")),
                                                                 testing::HasSubstr("No space left"))));
}

TEST_P(Writers, ReplaceAnOlderLongerFile) {
  const TempFolder folder;
  const auto old = folder.write("old", std::string(1 << 20, 'x'));
  GetParam().write(old);
  EXPECT_LT(readAll(old).size(), 1u << 20);
}

INSTANTIATE_TEST_SUITE_P(
    All, Writers,
    testing::Values(Writer{"MapImage",
                           [](const auto& file) {
                             writeMapImage(file, sampleGrid(), sampleTrajectory(), sampleFrames());
                           }},
                    Writer{"RosMap", [](const auto& file) { writeRosMap(file, sampleGrid()); }},
                    Writer{"GridMap", [](const auto& file) { writeGridMap(file, sampleGrid()); }},
                    Writer{"LargeGridMap", [](const auto& file) { writeGridMap(file, largeGrid()); }},
                    Writer{"SimpleMap", [](const auto& file) { writeSimpleMap(file, {}, {}); }},
                    Writer{"Scene",
                           [](const auto& file) {
                             writeScene(file, sampleGrid(), sampleTrajectory(), sampleFrames());
                           }},
                    Writer{"SceneLog",
                           [](const auto& file) {
                             writeSceneLog(file, sampleGrid(), sampleTrajectory(), sampleFrames());
                           }},
                    Writer{"LandmarkScene",
                           [](const auto& file) {
                             JoinedLandmarks joined;
                             joined.frames = sampleFrames();
                             writeLandmarkScene(file, joined, sampleTrajectory());
                           }},
                    Writer{"Text", [](const auto& file) { writeText(file, "seed = 1\n"); }},
                    Writer{"Tum", [](const auto& file) { writeTum(file, sampleTrajectory()); }},
                    Writer{"G2o", [](const auto& file) { writeG2o(file, sampleFrames(), {}); }},
                    Writer{"Json",
                           [](const auto& file) {
                             writeJson(file, {{"scans", 3}});
                           }}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace submap_slam
