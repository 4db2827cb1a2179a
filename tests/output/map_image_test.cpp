#include <gtest/gtest.h>
#include <png.h>
#include <submap_slam/output/map_image.h>

#include <stdexcept>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;

  const unsigned char* at(int u, int v) const { return &rgb[static_cast<std::size_t>(3 * (v * width + u))]; }
  int grey(int u, int v) const { return (at(u, v)[0] + at(u, v)[1] + at(u, v)[2]) / 3; }

  int count(bool (*is)(const unsigned char* rgb)) const {
    int n = 0;
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) n += is(at(u, v));
    return n;
  }
};

Picture readPng(const std::string& file) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, file.c_str()) == 0) throw std::runtime_error(image.message);
  image.format = PNG_FORMAT_RGB;
  Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr) == 0)
    throw std::runtime_error(image.message);
  return picture;
}

bool isBlue(const unsigned char* c) { return c[2] > 200 && c[0] < 120; }
bool isRed(const unsigned char* c) { return c[0] > 200 && c[2] < 120; }
bool isGreen(const unsigned char* c) { return c[1] > 110 && c[0] < 60 && c[2] < 100; }
bool isWhite(const unsigned char* c) { return c[0] > 245 && c[1] > 245 && c[2] > 245; }
bool isDark(const unsigned char* c) { return c[0] < 40 && c[1] < 40 && c[2] < 45; }

/** A long corridor: free, with a wall of one cell along its upper side. */
PackedEvidence corridor(unsigned length, unsigned width = 10) {
  EvidenceGrid grid(0, 0.1 * length, 0, 0.1 * width, 0.1);
  for (unsigned cx = 0; cx < length; ++cx)
    for (unsigned cy = 0; cy < width; ++cy) setCell(grid, cx, cy, cy + 1 == width ? 6.0f : -6.0f);
  return PackedEvidence(grid);
}

class MapImage : public testing::Test {
 protected:
  Picture write(const PackedEvidence& map, const Trajectory& trajectory,
                const std::vector<CPosePDFGaussian>& frames, int max_side = 4000) const {
    writeMapImage(folder.file("map.png"), map, trajectory, frames, max_side);
    return readPng(folder.file("map.png"));
  }
  TempFolder folder;
};

}  // namespace

TEST_F(MapImage, CellsAreWhereTheyBelongWithYUp) {
  const auto picture = write(sampleGrid(), {}, {});
  // 8 pixels per cell behind a margin of 20; the middles of the corner cells:
  const int left = 24, right = 20 + 3 * 8 + 4, top = 24, bottom = 20 + 2 * 8 + 4;
  EXPECT_LT(picture.grey(left, bottom), 40) << "occupied";
  EXPECT_GT(picture.grey(right, top), 245) << "free";
  EXPECT_NEAR(picture.grey(left, top), 224, 10) << "unknown";
  EXPECT_NEAR(picture.grey(right, bottom), 224, 10) << "unknown";
  EXPECT_LT(picture.grey(right - 8, top), 40) << "occupied";
}

TEST_F(MapImage, TrajectoryGoesFromBlueToRedByTime) {
  const auto without = write(corridor(100), {}, {});
  EXPECT_EQ(without.count(isBlue), 0);
  EXPECT_EQ(without.count(isRed), 0);
  Trajectory there_and_back;
  for (int i = 0; i <= 100; ++i) there_and_back.push_back(stamped(i, 0.1 * i, 0.3, 0));
  const auto picture = write(corridor(100), there_and_back, {});
  const int row = 20 + 80 - 8 * 3;  // 8 pixels per cell, 3 cells above the lower edge
  EXPECT_TRUE(isBlue(picture.at(20 + 20, row)));
  EXPECT_TRUE(isRed(picture.at(20 + 780, row)));
  EXPECT_FALSE(isBlue(picture.at(20 + 400, row)));
  EXPECT_FALSE(isRed(picture.at(20 + 400, row)));
}

TEST_F(MapImage, FramesAreDots) {
  EXPECT_EQ(write(corridor(100), {}, {}).count(isGreen), 0);
  const auto one = write(corridor(100), {}, {gaussian(3, 0.5, 0)});
  EXPECT_TRUE(isGreen(one.at(20 + 240, 20 + 40)));
  EXPECT_EQ(write(corridor(100), {}, {gaussian(3, 0.5, 0), gaussian(6, 0.5, 0)}).count(isGreen),
            2 * one.count(isGreen));
}

TEST_F(MapImage, LargeMapStaysWithinTheLimitAndKeepsThinWalls) {
  const auto picture = write(corridor(3000, 100), {}, {}, 400);
  EXPECT_LE(picture.width, 400);
  EXPECT_LE(picture.height, 400);
  EXPECT_GT(picture.width, 300);
  EXPECT_GT(picture.count(isDark), 290);
  EXPECT_GT(picture.count(isWhite), 0);
}

TEST_F(MapImage, SmallestAndEmptyMapsAreDrawn) {
  EXPECT_GT(write(PackedEvidence(), {}, {}).width, 0);
  PackedEvidence one;
  one.set(0, 0, 5, 1);
  EXPECT_GT(write(one, {stamped(0, 0, 0, 0)}, {gaussian(0, 0, 0)}).count(isDark), 0);
}

TEST_F(MapImage, PointsFarOutsideAreHarmless) {
  const auto picture =
      write(corridor(50), {stamped(0, -1e15, 0, 0), stamped(1, 1e15, 1e12, 0)}, {gaussian(1e300, -1e300, 0)});
  EXPECT_GT(picture.count(isWhite), 0);
}

TEST_F(MapImage, SameBytesEachTime) {
  writeMapImage(folder.file("a.png"), sampleGrid(), sampleTrajectory(), sampleFrames());
  writeMapImage(folder.file("b.png"), sampleGrid(), sampleTrajectory(), sampleFrames());
  EXPECT_EQ(readAll(folder.file("a.png")), readAll(folder.file("b.png")));
}

TEST_F(MapImage, LimitMustLeaveRoom) { EXPECT_THROW(write(sampleGrid(), {}, {}, 50), std::invalid_argument); }

}  // namespace submap_slam
