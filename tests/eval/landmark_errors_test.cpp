#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/landmark_errors.h>

#include <cmath>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;

constexpr double kPi = 3.141592653589793;

JoinedLandmark landmarkAt(uint32_t id, double x, double y, double variance) {
  JoinedLandmark landmark;
  landmark.id = id;
  landmark.x = x;
  landmark.y = y;
  landmark.covariance.setZero();
  landmark.covariance(0, 0) = landmark.covariance(1, 1) = variance;
  return landmark;
}

template <class Call>
std::string errorOf(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ConsistencyIndex, IsOneAtTheNinetyFivePercentQuantile) {
  EXPECT_NEAR(consistencyIndex(5.9915, 2), 1, 1e-3);  // tables of χ²
  EXPECT_NEAR(consistencyIndex(7.8147, 3), 1, 1e-3);
  EXPECT_EQ(consistencyIndex(0, 3), 0);
}

TEST(LandmarkErrors, HandWorkedCase) {
  // the map lies at (10, 0), turned by 90°: its (1, 2) is (8, 1) of the truth
  const TPose2D T_truth_map(10, 0, kPi / 2);
  const LandmarkTruth truth{{1, {8, 1}}, {2, {10, 5}}};  // in the map: (1, 2) and (5, 0)
  const auto errors =
      landmarkErrors({landmarkAt(1, 1, 2, 1), landmarkAt(2, 8, 4, 0.25), landmarkAt(3, 0, 0, 1)}, truth,
                     T_truth_map, LandmarkMatch::kById);
  EXPECT_EQ(errors.compared, 2u);
  EXPECT_EQ(errors.unknown, 1u);
  EXPECT_NEAR(errors.rmse_m, std::sqrt(25.0 / 2), 1e-9);  // errors 0 and 5 m
  EXPECT_NEAR(errors.mean_nees, 100.0 / 2, 1e-6);         // 5² / 0.25
  EXPECT_NEAR(errors.mean_index, 50 / 5.9915, 1e-2);
}

TEST(LandmarkErrors, OfNothingAreZero) {
  for (const auto match : {LandmarkMatch::kById, LandmarkMatch::kByPosition}) {
    EXPECT_EQ(landmarkErrors({}, {}, {}, match).compared, 0u);
    EXPECT_EQ(landmarkErrors({landmarkAt(1, 0, 0, 1)}, {}, {}, match).rmse_m, 0);
  }
}

TEST(LandmarkErrors, ByPositionIdsSayNothing) {
  const TPose2D T_truth_map(10, 0, kPi / 2);
  const LandmarkTruth truth{{1, {10, 5}}, {2, {8, 1}}};  // in the map: (5, 0) and (1, 2)
  const auto errors = landmarkErrors({landmarkAt(1, 1, 3, 1), landmarkAt(2, 5, 0, 1)}, truth, T_truth_map,
                                     LandmarkMatch::kByPosition);
  EXPECT_EQ(errors.compared, 2u);
  EXPECT_NEAR(errors.rmse_m, std::sqrt(1 / 2.0), 1e-9);
  EXPECT_NEAR(errors.mean_nees, 1 / 2.0, 1e-9);
}

TEST(LandmarkErrors, ByPositionEachTrueOneIsTakenOnceAndNoneBeyondTheGate) {
  const LandmarkTruth truth{{1, {0, 0}}, {2, {2.5, 0}}, {3, {50, 0}}};
  // the second is nearest to the first true one, but the first landmark is nearer still
  const auto errors = landmarkErrors(
      {landmarkAt(1, 0.5, 0, 1), landmarkAt(2, 1.0, 0, 1), landmarkAt(3, 50 + 1.01 * kLandmarkGate_m, 0, 1)},
      truth, {}, LandmarkMatch::kByPosition);
  EXPECT_EQ(errors.compared, 2u);
  EXPECT_EQ(errors.unknown, 1u);
  EXPECT_NEAR(errors.rmse_m, std::sqrt((0.5 * 0.5 + 1.5 * 1.5) / 2), 1e-9);
}

TEST(LandmarkFiles, AreReadBack) {
  TempFolder temp;
  const auto truth = readLandmarkTruth(temp.write("truth.csv", "id,x,y\n7,1.5,-2\n9,0,0\n"));
  EXPECT_EQ(truth.size(), 2u);
  EXPECT_EQ(truth.at(7).y, -2);
  const auto landmarks =
      readMappedLandmarks(temp.write("map.csv", "id,x,y,sxx,sxy,syy,hits\n7,1,2,0.1,0.01,0.2,12\n"));
  ASSERT_EQ(landmarks.size(), 1u);
  EXPECT_EQ(landmarks[0].covariance(1, 0), 0.01);
  EXPECT_EQ(landmarks[0].hits, 12u);
  EXPECT_TRUE(readMappedLandmarks(temp.write("none.csv", "id,x,y,sxx,sxy,syy,hits\n")).empty());
}

TEST(LandmarkFiles, OfAnotherKindAreRefused) {
  TempFolder temp;
  const auto refusal = [&](const std::string& text) {
    const auto file = temp.write("bad.csv", text);
    return errorOf([&] { readLandmarkTruth(file); });
  };
  EXPECT_THAT(refusal("x,y\n1,2\n"), HasSubstr("bad.csv:1: expected the head id,x,y"));
  EXPECT_THAT(refusal("id,x,y\n1,2\n"), HasSubstr("bad.csv:2: 2 columns, expected 3"));
  EXPECT_THAT(refusal("id,x,y\n1,2,nan\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal("id,x,y\n1.5,2,3\n"), HasSubstr("no whole number"));
  EXPECT_THAT(refusal("id,x,y\n1,2,3\n1,4,5\n"), HasSubstr("bad.csv:3: the id 1 occurs twice"));
  EXPECT_THAT(errorOf([&] { readLandmarkTruth(temp.file("missing")); }), HasSubstr("cannot be opened"));
}

TEST(FrameErrors, HandWorkedCase) {
  TempFolder temp;
  const auto frames = readTimedFrames(temp.write("frames.csv",
                                                 "stamp,x,y,phi,sxx,sxy,sxp,syy,syp,spp\n"
                                                 "0,0,0,0,0,0,0,0,0,0\n"
                                                 "1,3,4,0.5,4,0,0,16,0,0.25\n"
                                                 "99,0,0,0,1,0,0,1,0,1\n"));
  ASSERT_EQ(frames.size(), 3u);
  // the truth starts at (1, 1) with heading 90°; after 1 s it is 2 m ahead and 2 m to the left, turned by 0
  const TimedTrajectory truth(
      std::vector<TimedPose>{{0, toPose3D({1, 1, kPi / 2})}, {1, toPose3D({-1, 3, kPi / 2})}});
  const auto errors = frameErrors(frames, truth, {1, 1, kPi / 2});
  ASSERT_EQ(errors.size(), 1u);  // the first has no covariance, the last no truth
  EXPECT_NEAR(errors[0].error.x, 1, 1e-9);
  EXPECT_NEAR(errors[0].error.y, 2, 1e-9);
  EXPECT_NEAR(errors[0].error.phi, 0.5, 1e-9);
  EXPECT_NEAR(errors[0].sigma_y, 4, 1e-12);
  EXPECT_NEAR(errors[0].nees, 0.25 + 0.25 + 1, 1e-9);
  EXPECT_NEAR(errors[0].index, 1.5 / 7.8147, 1e-4);
  EXPECT_THAT(frameErrorsCsv(errors),
              HasSubstr("\n1.000000,1.000000,2.000000,0.50000000,2.000000,4.000000,"));
  const auto again = readFrameErrors(temp.write("consistency.csv", frameErrorsCsv(errors)));
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(frameErrorsCsv(again), frameErrorsCsv(errors));
}

}  // namespace
}  // namespace submap_slam
