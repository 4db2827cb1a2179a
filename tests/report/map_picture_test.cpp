#include <gmock/gmock.h>
#include <png.h>
#include <submap_slam/report/map_picture.h>

#include <cmath>
#include <memory>

#include "../output/sample_results.h"

namespace submap_slam {
namespace {

using ::testing::ElementsAre;
constexpr uint8_t kUnknown = MapPicture::kUnknown;

TEST(MapPicture, ShowsTheObservedPartFromTheTop) {
  const MapPicture picture = mapPicture(sampleGrid(), 100);
  ASSERT_EQ(picture.width, 4);
  ASSERT_EQ(picture.height, 3);
  EXPECT_DOUBLE_EQ(picture.x_min, -1);
  EXPECT_DOUBLE_EQ(picture.y_min, 2);
  EXPECT_DOUBLE_EQ(picture.xMax(), 1);
  EXPECT_DOUBLE_EQ(picture.yMax(), 3.5);
  // Evidence of ±4 is nearly certain, 0.1 nearly undecided (between the 7 shades below and above the middle).
  EXPECT_THAT(picture.shades, ElementsAre(kUnknown, kUnknown, 15, 1,  //
                                          1, 1, 8, kUnknown,          //
                                          15, 1, kUnknown, kUnknown));
}

TEST(MapPicture, LeavesOutWhatNobodySaw) {
  PackedEvidence grid(-50, 50, -50, 50, 0.5);
  grid.set(100, 90, -5, 1);
  grid.set(102, 91, 5, 1);
  const MapPicture picture = mapPicture(grid, 100);
  EXPECT_EQ(picture.width, 3);
  EXPECT_EQ(picture.height, 2);
  EXPECT_DOUBLE_EQ(picture.x_min, 0);
  EXPECT_DOUBLE_EQ(picture.y_min, -5);
}

TEST(MapPicture, OfCellsThatShareAPixelTheMostOccupiedOneShows) {
  const MapPicture picture = mapPicture(sampleGrid(), 2);
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 2);
  EXPECT_DOUBLE_EQ(picture.m_per_px, 1);
  EXPECT_DOUBLE_EQ(picture.y_min, 2);
  EXPECT_THAT(picture.shades, ElementsAre(kUnknown, 15, 15, 8)) << "rows are grouped from the lowest up";
}

TEST(MapPicture, OfNothingIsEmpty) {
  EXPECT_THAT(mapPicture(PackedEvidence(), 100).shades, ElementsAre(kUnknown));
}

TEST(MapPicture, OfMrptsMapIsTheSameWhereItIsNotMoved) {
  const MapPicture picture = mapPicture(sampleGrid().toOccupancyGrid(), {}, 100);
  MapPicture expected = mapPicture(sampleGrid(), 100);
  EXPECT_EQ(picture.width, expected.width);
  EXPECT_EQ(picture.height, expected.height);
  expected.shades[6] = 9;  // MRPT's cells are sixteenths: 0.1 becomes 2/16
  EXPECT_EQ(picture.shades, expected.shades);
  EXPECT_NEAR(picture.x_min, expected.x_min, 1e-6);
  EXPECT_NEAR(picture.yMax(), expected.yMax(), 1e-6);
}

TEST(MapPicture, TurnsMrptsMapByAQuarterToTheLeft) {
  const MapPicture picture = mapPicture(sampleGrid().toOccupancyGrid(), {10, 20, M_PI / 2}, 100);
  ASSERT_EQ(picture.width, 3);
  ASSERT_EQ(picture.height, 4);
  EXPECT_NEAR(picture.x_min, 10 - 3.5, 1e-6) << "x = 10 − y";
  EXPECT_NEAR(picture.y_min, 20 - 1, 1e-6) << "y = 20 + x";
  EXPECT_THAT(picture.shades, ElementsAre(1, kUnknown, kUnknown,  //
                                          15, 9, kUnknown,        //
                                          kUnknown, 1, 1,         //
                                          kUnknown, 1, 15));
}

TEST(MapPicture, PngHasItsColours) {
  const std::string uri = pngDataUri(mapPicture(sampleGrid(), 100)), begin = "data:image/png;base64,";
  ASSERT_EQ(uri.substr(0, begin.size()), begin);
  std::string bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : uri.substr(begin.size())) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGBA;
  std::vector<png_byte> rgba(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr), 0) << image.message;
  const auto pixel = [&](std::size_t i) {
    return std::vector<int>(rgba.begin() + static_cast<std::ptrdiff_t>(4 * i),
                            rgba.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
  };
  EXPECT_EQ(pixel(0)[3], 0) << "unknown is transparent";
  EXPECT_THAT(pixel(2), ElementsAre(16, 16, 16, 255)) << "occupied";
  EXPECT_THAT(pixel(3), ElementsAre(255, 255, 255, 255)) << "free";
}

}  // namespace
}  // namespace submap_slam
