#include <gtest/gtest.h>
#include <submap_slam/output/trajectory_file.h>

#include <cmath>
#include <sstream>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

std::vector<std::vector<std::string>> dataColumns(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.front() == '#') continue;
    std::istringstream columns(line);
    rows.emplace_back();
    for (std::string column; columns >> column;) rows.back().push_back(column);
  }
  return rows;
}

}  // namespace

TEST(WriteTum, KeepsStampsToTheMicrosecondAndPosesToNineDigits) {
  const TempFolder folder;
  writeTum(folder.file("a.tum"), {stamped(976052890.244111, 123.456789012, -0.000123456789, 2.5)});
  const auto rows = dataColumns(readAll(folder.file("a.tum")));
  ASSERT_EQ(rows.size(), 1u);
  ASSERT_EQ(rows[0].size(), 8u);
  EXPECT_EQ(rows[0][0], "976052890.244111");
  EXPECT_NEAR(std::stod(rows[0][1]), 123.456789012, 1e-9);
  EXPECT_NEAR(std::stod(rows[0][2]), -0.000123456789, 1e-15);
  for (const int planar : {3, 4, 5}) EXPECT_EQ(rows[0][static_cast<std::size_t>(planar)], "0");
  EXPECT_NEAR(2 * std::atan2(std::stod(rows[0][6]), std::stod(rows[0][7])), 2.5, 1e-11);
}

TEST(WriteTum, OneLineForEachStampInLogOrderWithTheLastPose) {
  const TempFolder folder;
  writeTum(folder.file("a.tum"),
           {stamped(20, 1, 0, 0), stamped(10, 2, 0, 0), stamped(20, 3, 0, 0), stamped(30, 4, 0, 0)});
  const auto rows = dataColumns(readAll(folder.file("a.tum")));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0][0], "20.000000");
  EXPECT_EQ(rows[0][1], "3");
  EXPECT_EQ(rows[1][0], "10.000000");
  EXPECT_EQ(rows[2][1], "4");
}

TEST(WriteTum, EmptyTrajectoryGivesAFileWithoutPoses) {
  const TempFolder folder;
  writeTum(folder.file("a.tum"), {});
  EXPECT_TRUE(dataColumns(readAll(folder.file("a.tum"))).empty());
}

}  // namespace submap_slam
