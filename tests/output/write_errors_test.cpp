#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/map_image.h>
#include <submap_slam/output/mrpt_files.h>
#include <submap_slam/output/ros_map.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/output/trajectory_file.h>

#include <functional>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

struct Writer {
  const char* name;
  std::function<void(const std::string& file)> write;
};

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
                    Writer{"SimpleMap", [](const auto& file) { writeSimpleMap(file, {}, {}); }},
                    Writer{"Scene",
                           [](const auto& file) {
                             writeScene(file, sampleGrid(), sampleTrajectory(), sampleFrames());
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
