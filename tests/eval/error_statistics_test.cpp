#include <gtest/gtest.h>
#include <submap_slam/eval/error_statistics.h>

#include <cmath>

namespace submap_slam {

TEST(ErrorStatistics, HandWorkedInAnyOrder) {
  const auto s = errorStatistics({3, 1, 4, 2});
  EXPECT_EQ(s.count, 4u);
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(5.0 / 3.0));
  EXPECT_DOUBLE_EQ(s.squared_mean, 7.5);
  EXPECT_DOUBLE_EQ(s.squared_std, std::sqrt(43.0));
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.median, 3);
  EXPECT_DOUBLE_EQ(s.percentile_95, 4);
  EXPECT_DOUBLE_EQ(s.max, 4);
}

TEST(ErrorStatistics, Percentile95IsNotTheMaximumOfALargeSet) {
  std::vector<double> errors;
  for (int i = 0; i < 100; ++i) errors.push_back(i);
  const auto s = errorStatistics(errors);
  EXPECT_DOUBLE_EQ(s.median, 50);
  EXPECT_DOUBLE_EQ(s.percentile_95, 95);
  EXPECT_DOUBLE_EQ(s.max, 99);
}

TEST(ErrorStatistics, OneSampleHasNoSpreadAndNoneIsZero) {
  const auto one = errorStatistics({2});
  EXPECT_DOUBLE_EQ(one.mean, 2);
  EXPECT_DOUBLE_EQ(one.std, 0);
  EXPECT_DOUBLE_EQ(one.squared_std, 0);
  EXPECT_DOUBLE_EQ(one.median, 2);
  const auto none = errorStatistics({});
  EXPECT_EQ(none.count, 0u);
  EXPECT_DOUBLE_EQ(none.max, 0);
}

}  // namespace submap_slam
