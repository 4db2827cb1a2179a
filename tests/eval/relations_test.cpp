#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/relations.h>

#include <cmath>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/** Poses and relations with all six degrees of freedom: an exact stamp, a nearly exact one, two between
 * poses, a stamp that comes twice, a gap that is too long, one before the start, one relation backwards in
 * time. */
constexpr char kTrajectory[] =
    "# t x y z qx qy qz qw\n"
    "100.0 0 0 0 0 0 0 1\n"
    "101.0 1.0 0.1 0.02 0.01 0.02 0.1 0.99\n"
    "102.0 1.9 0.4 0.05 0.02 -0.03 0.3 0.95\n"
    "103.0 9 9 9 0 0 0 1\n"
    "103.0 2.5 1.2 0.04 0.0 0.05 0.5 0.86\n"
    "130.0 2.2 2.4 -0.01 -0.04 0.01 0.8 0.6\n"
    "175.0 0.3 0.2 0.0 0.0 0.01 -0.05 0.998\n";
constexpr char kRelations[] =
    "# t1 t2 x y z roll pitch yaw\n"
    "100.0 101.0 1.02 0.08 0.0 0.0 0.01 0.22\n"
    "101.0 102.0004 0.93 0.12 0.01 0.03 -0.02 0.41\n"
    "102.0 103.0 1.0 0.35 0 0 0 0.45\n"
    "100.5 102.25 1.4 0.5 0.05 0.1 0.05 0.6\n"
    "103.0 175.0 -1.6 2.0 0.1 0 0.02 -1.1\n"
    "100.0 130.0 2.3 2.3 0 0 0 1.8\n"
    "130.0 175.0 -2.0 1.7 0 0 0 -2.0\n"
    "110.0 175.0 1 1 0 0 0 0\n"
    "175.0 100.0 -0.35 -0.2 0.01 0.01 0.02 0.12\n"
    "99.0 100.0 1 0 0 0 0 0\n";

/** Numbers that a separate evaluator (Python, standard library only) gives for these files. */
void expectStatistics(const ErrorStatistics& s, double mean, double std, double squared_mean,
                      double squared_std, double median, double max) {
  constexpr double kTolerance = 1e-9;
  EXPECT_NEAR(s.mean, mean, kTolerance);
  EXPECT_NEAR(s.std, std, kTolerance);
  EXPECT_NEAR(s.squared_mean, squared_mean, kTolerance);
  EXPECT_NEAR(s.squared_std, squared_std, kTolerance);
  EXPECT_NEAR(s.median, median, kTolerance);
  EXPECT_NEAR(s.percentile_95, max, kTolerance);
  EXPECT_NEAR(s.max, max, kTolerance);
}

void expectCounts(const RelationsResult& r, std::size_t used, std::size_t skipped, std::size_t filtered) {
  EXPECT_EQ(r.used, used);
  EXPECT_EQ(r.skipped, skipped);
  EXPECT_EQ(r.filtered, filtered);
  EXPECT_EQ(r.total, used + skipped + filtered);
}

class RelationsFiles : public testing::Test {
 protected:
  RelationsReport report(const TimedTrajectory& of) const { return evaluateRelationsSplit(relations, of); }

  TempFolder folder;
  std::vector<Relation> relations = readRelations(folder.write("a.relations", kRelations));
  TimedTrajectory trajectory = readTum(folder.write("a.tum", kTrajectory));
};

}  // namespace

TEST_F(RelationsFiles, AgreesWithAnotherEvaluatorOnAllRelations) {
  const auto r = report(trajectory).all;
  expectCounts(r, 8, 2, 0);
  expectStatistics(r.translation_m, 0.284299697022, 0.334673186308, 0.178831691656, 0.304648404088,
                   0.141774468788, 0.852199246629);
  expectStatistics(r.rotation_deg, 5.731509385634, 2.457763669595, 38.135726811243, 29.183311389654,
                   6.145347050059, 9.753975381390);
}

TEST_F(RelationsFiles, AgreesWithAnotherEvaluatorOnGlobalRelations) {
  const auto r = report(trajectory).global;
  expectCounts(r, 2, 1, 7);
  expectStatistics(r.translation_m, 0.430660885535, 0.497612198548, 0.309277748402, 0.428604220159,
                   0.782525845529, 0.782525845529);
  expectStatistics(r.rotation_deg, 4.561468495150, 2.724420613203, 24.518228671067, 24.854717589322,
                   6.487924785550, 6.487924785550);
}

TEST_F(RelationsFiles, AgreesWithAnotherEvaluatorOnLocalRelations) {
  const auto r = report(trajectory).local;
  expectCounts(r, 6, 1, 3);
  expectStatistics(r.translation_m, 0.235512634184, 0.309612929732, 0.135349672741, 0.290033277402,
                   0.141774468788, 0.852199246629);
  expectStatistics(r.rotation_deg, 6.121523015795, 2.498443233310, 42.674892857968, 31.142915655473,
                   6.145347050059, 9.753975381390);
}

TEST_F(RelationsFiles, RigidlyMovedTrajectoryHasTheSameErrors) {
  const Pose3D T_new_old = poseFromRpy(-40, 12, 3, 0.3, -0.8, 2.5);
  std::vector<TimedPose> moved = trajectory.poses();
  for (auto& p : moved) p.pose = T_new_old * p.pose;
  const auto a = report(trajectory).all, b = report(TimedTrajectory(moved)).all;
  EXPECT_EQ(a.used, b.used);
  EXPECT_NEAR(a.translation_m.mean, b.translation_m.mean, 1e-10);
  EXPECT_NEAR(a.translation_m.max, b.translation_m.max, 1e-10);
  EXPECT_NEAR(a.rotation_deg.mean, b.rotation_deg.mean, 1e-9);
  EXPECT_NEAR(a.rotation_deg.std, b.rotation_deg.std, 1e-9);
}

TEST_F(RelationsFiles, TableHoldsTheNumbers) {
  const auto table = formatTable(report(trajectory));
  EXPECT_THAT(table, HasSubstr("0.2843 ± 0.3347"));
  EXPECT_THAT(table, HasSubstr("4.5615 ± 2.7244"));
  EXPECT_THAT(table, HasSubstr("local  <= 60 s"));
}

TEST(Relations, HandWorkedThreePoses) {
  // Forward 2 m, quarter turn to the left, forward 1 m.
  const TimedTrajectory trajectory({{0, poseFromRpy(5, 5, 0, 0, 0, 0)},
                                    {1, poseFromRpy(7, 5, 0, 0, 0, M_PI / 2)},
                                    {2, poseFromRpy(7, 6, 0, 0, 0, M_PI / 2)}});
  const std::vector<Relation> relations = {
      {0, 1, poseFromRpy(2, 0, 0, 0, 0, M_PI / 2)},                         // exact
      {1, 2, poseFromRpy(0.7, 0.4, 0, 0, 0, 0)},                            // 0.3 m and 0.4 m off
      {0, 2, poseFromRpy(2, 1, 0, 0, 0, M_PI / 2 - mrpt::DEG2RAD(10.0))}};  // 10° off
  const auto r = evaluateRelations(relations, trajectory);
  expectCounts(r, 3, 0, 0);
  EXPECT_NEAR(r.translation_m.mean, 0.5 / 3, 1e-12);
  EXPECT_NEAR(r.translation_m.max, 0.5, 1e-12);
  EXPECT_NEAR(r.rotation_deg.max, 10, 1e-9);
  EXPECT_NEAR(r.rotation_deg.squared_mean, 100.0 / 3, 1e-8);
}

TEST(Relations, TheLimitOfTheTimeSplitIsLocalAlone) {
  const TimedTrajectory trajectory({{0, {}}, {60, {}}, {60.001, {}}});
  const auto report = evaluateRelationsSplit({{0, 60, {}}, {0, 60.001, {}}}, trajectory, 60);
  expectCounts(report.all, 2, 0, 0);
  expectCounts(report.local, 1, 0, 1);
  expectCounts(report.global, 1, 0, 1);
}

TEST(Relations, TheTableHasNoNumbersWhereNothingWasEvaluated) {
  const TimedTrajectory trajectory({{0, {}}, {10, {}}});
  const auto table = formatTable(evaluateRelationsSplit({{0, 10, {}}}, trajectory, 60));
  const auto global = table.substr(table.find("global > 60 s"));
  EXPECT_THAT(global, HasSubstr("- ± -"));
  EXPECT_THAT(global, Not(HasSubstr("0.0000")));
  EXPECT_THAT(table, HasSubstr("0.0000 ± 0.0000")) << "the local one is perfect";
}

TEST(Relations, NoneEvaluatedIsAResultWithoutNumbers) {
  const auto r = evaluateRelations({{0, 1, {}}}, TimedTrajectory());
  expectCounts(r, 0, 1, 0);
  EXPECT_EQ(r.translation_m.count, 0u);
}

TEST(ReadRelations, BadInputNamesFileAndLine) {
  const TempFolder folder;
  const auto file = folder.write("bad.relations", "# t1 t2 x y z roll pitch yaw\n1 2 0 0 0 0 0 0\n1 2 0 0\n");
  EXPECT_THAT([&] { readRelations(file); },
              ThrowsMessage<InputError>(HasSubstr(file + ":3: 4 columns, expected 8")));
  const auto nan = folder.write("nan.relations", "1 2 0 0 0 0 0 NaN\n");
  EXPECT_THAT([&] { readRelations(nan); }, ThrowsMessage<InputError>(HasSubstr(nan + ":1: 'NaN'")));
  const auto empty = folder.write("empty.relations", "");
  EXPECT_THAT([&] { readRelations(empty); }, ThrowsMessage<InputError>(HasSubstr(empty + ": holds no data")));
  EXPECT_THROW(readRelations(folder.file("")), InputError);
}

}  // namespace submap_slam
