#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <submap_slam/output/ros_map.h>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {

TEST(WriteRosMap, PictureIsByteForByteWhatMapServerExpects) {
  const TempFolder folder;
  writeRosMap(folder.file("map.yaml"), sampleGrid());
  const auto pixels = [](const char* four) { return std::string(four, 4); };
  EXPECT_EQ(readAll(folder.file("map.pgm")), "P5\n4 3\n255\n" + pixels("\xCD\xCD\x00\xFE") +
                                                 pixels("\xFE\xFE\xCD\xCD") + pixels("\x00\xFE\xCD\xCD"));
}

TEST(WriteRosMap, YamlNamesThePictureBesideItAndTheLowerLeftCorner) {
  const TempFolder folder;
  writeRosMap(folder.file("office.yaml"), sampleGrid());
  const auto yaml = readAll(folder.file("office.yaml"));
  EXPECT_THAT(yaml, testing::HasSubstr("image: office.pgm\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("resolution: 0.500000000\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("origin: [-1.000000000, 2.000000000, 0.0]\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("mode: trinary\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("negate: 0\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("occupied_thresh: 0.65\n"));
  EXPECT_THAT(yaml, testing::HasSubstr("free_thresh: 0.196\n"));
}

TEST(WriteRosMap, MrptReadsTheSameCellsInTheSamePlaces) {
  const TempFolder folder;
  writeRosMap(folder.file("map.yaml"), sampleGrid());
  mrpt::maps::COccupancyGridMap2D map;
  ASSERT_TRUE(map.loadFromROSMapServerYAML(folder.file("map.yaml")));
  EXPECT_FLOAT_EQ(map.getXMin(), -1);
  EXPECT_FLOAT_EQ(map.getXMax(), 1);
  EXPECT_FLOAT_EQ(map.getYMin(), 2);
  EXPECT_FLOAT_EQ(map.getYMax(), 3.5);
  EXPECT_FLOAT_EQ(map.getResolution(), 0.5);
  EXPECT_LT(map.getPos(-0.75f, 2.25f), 0.1f);
  EXPECT_GT(map.getPos(-0.25f, 2.25f), 0.9f);
  EXPECT_LT(map.getPos(0.25f, 3.25f), 0.1f);
  EXPECT_GT(map.getPos(0.75f, 3.25f), 0.9f);
  EXPECT_NEAR(map.getPos(0.75f, 2.25f), 0.5f, 0.05f);
  EXPECT_NEAR(map.getPos(0.25f, 2.75f), 0.5f, 0.05f);
}

}  // namespace submap_slam
