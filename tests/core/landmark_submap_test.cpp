#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/joined_landmarks.h>

#include <limits>
#include <sstream>

namespace submap_slam {
namespace {

using ::testing::HasSubstr;

/** Two features, all variances 0.01 and one covariance. */
LandmarkSubmap twoFeatures() {
  LandmarkSubmap submap;
  submap.id = 4;
  submap.end_stamp = mrpt::Clock::fromDouble(12.5);
  submap.end_pose = {1.5, -0.25, 0.125};
  submap.features = {{7, 3, 4, 11}, {9, -1, 2, 5}};
  submap.covariance.setIdentity(7);
  submap.covariance *= 0.01;
  submap.covariance(4, 0) = submap.covariance(0, 4) = 0.002;
  submap.ids_known = false;
  submap.nodes = {{mrpt::Clock::fromDouble(10), {}}, {mrpt::Clock::fromDouble(11), {0.5, 0.25, 0.125}}};
  return submap;
}

std::string refusal(const LandmarkSubmap& submap) {
  try {
    requireUsable(submap);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return {};
}

TEST(LandmarkSubmap, IsReadBackAsItWasWritten) {
  const LandmarkSubmap written = twoFeatures();
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << written;
  memory.Seek(0);
  const auto read = archive.ReadObject<LandmarkSubmap>();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->id, 4u);
  EXPECT_EQ(read->end_stamp, written.end_stamp);
  EXPECT_EQ(read->end_pose, written.end_pose);
  ASSERT_EQ(read->features.size(), 2u);
  EXPECT_EQ(read->features[1].id, 9u);
  EXPECT_EQ(read->features[1].y, 2);
  EXPECT_EQ(read->features[0].hits, 11u);
  EXPECT_EQ(read->covariance, written.covariance);
  EXPECT_FALSE(read->ids_known);
  ASSERT_EQ(read->nodes.size(), 2u);
  EXPECT_EQ(read->nodes[1].stamp, written.nodes[1].stamp);
  EXPECT_EQ(read->nodes[1].pose, written.nodes[1].pose);
}

/** Version 0 had neither the word on the ids nor the path. */
TEST(LandmarkSubmap, Version0IsStillRead) {
  LandmarkSubmap written = twoFeatures();
  written.nodes.clear();
  mrpt::io::CMemoryStream memory;
  mrpt::serialization::archiveFrom(memory) << written;
  std::string bytes(static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount());
  const std::string name = "submap_slam::LandmarkSubmap";
  char& version = bytes[bytes.find(name) + name.size()];
  ASSERT_EQ(version, 1);
  version = 0;
  constexpr std::size_t kAdded = sizeof(bool) + sizeof(uint32_t), kEndMark = 1;
  bytes.erase(bytes.size() - kEndMark - kAdded, kAdded);

  mrpt::io::CMemoryStream old;
  old.Write(bytes.data(), bytes.size());
  old.Seek(0);
  auto archive = mrpt::serialization::archiveFrom(old);
  const auto read = archive.ReadObject<LandmarkSubmap>();
  ASSERT_TRUE(read);
  EXPECT_EQ(read->features[1].id, 9u);
  EXPECT_EQ(read->covariance, written.covariance);
  EXPECT_TRUE(read->ids_known);
  EXPECT_TRUE(read->nodes.empty());
  EXPECT_EQ(old.getPosition(), bytes.size());
}

/** Two submaps of 4 m along x, the second one turned left at the end of the first. */
LandmarkSubmaps twoStraights() {
  LandmarkSubmaps submaps;
  for (int k = 0; k < 2; ++k) {
    auto submap = LandmarkSubmap::Create();
    submap->end_pose = {4, 0, 0};
    for (int i = 0; i < 4; ++i)
      submap->nodes.push_back({mrpt::Clock::fromDouble(4.0 * k + i), {static_cast<double>(i), 0, 0}});
    submap->end_stamp = mrpt::Clock::fromDouble(4.0 * k + 4);
    submaps.push_back(submap);
  }
  return submaps;
}

JoinedLandmarks joinedAt(const std::vector<mrpt::math::TPose2D>& frames) {
  JoinedLandmarks joined;
  for (const auto& frame : frames)
    joined.frames.emplace_back(mrpt::poses::CPose2D(frame), mrpt::math::CMatrixDouble33());
  return joined;
}

TEST(TrajectoryOfLandmarks, SpreadsWhatJoiningChangedOverTheNodes) {
  // The first submap ends 0.4 m farther left than it thought; the second as it thought, from there.
  const auto path = trajectoryOf(twoStraights(), joinedAt({{0, 0, 0}, {4, 0.4, 0}, {8, 0.4, 0}}));
  ASSERT_EQ(path.size(), 8u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(path[i].pose.x, static_cast<double>(i), 1e-12);
    EXPECT_NEAR(path[i].pose.y, 0.1 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(path[4 + i].pose.y, 0.4, 1e-12);
  }
  EXPECT_EQ(path[5].stamp, mrpt::Clock::fromDouble(5));
}

TEST(TrajectoryOfLandmarks, OfSubmapsWithoutNodesHasTheirEnds) {
  auto submaps = twoStraights();
  submaps[0]->nodes.clear();
  const auto joined = joinedAt({{0, 0, 0}, {4, 0, 0}, {8, 1, 0}});
  EXPECT_EQ(trajectoryOf(submaps, joined)[1].stamp, submaps[1]->end_stamp);
  EXPECT_EQ(trajectoryOf(submaps, joined)[1].pose.y, 1);
  submaps[1]->end_stamp = INVALID_TIMESTAMP;
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(trajectoryOf(submaps, joined)[k].stamp, mrpt::Clock::fromDouble(static_cast<double>(k)));
}

TEST(TrajectoryOfLandmarks, RefusesFramesThatDoNotFit) {
  EXPECT_THROW(trajectoryOf(twoStraights(), joinedAt({{0, 0, 0}})), std::invalid_argument);
}

TEST(LandmarkSubmap, WithACovarianceOfTheWrongSizeIsNotWritten) {
  LandmarkSubmap submap = twoFeatures();
  submap.covariance.setIdentity(5);
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  EXPECT_THROW(archive << submap, std::exception);
}

TEST(LandmarkSubmap, WithADamagedCountIsRefusedBeforeMemoryIsTaken) {
  LandmarkSubmap submap;
  submap.covariance.setIdentity(3);
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  const auto bytes_of = [](const mrpt::io::CMemoryStream& m) {
    return static_cast<std::size_t>(m.getTotalBytesCount());
  };
  archive << submap;
  // Behind the count are six numbers of the covariance, whether ids are known, the number of nodes and the
  // end mark of the object.
  auto* count = static_cast<uint8_t*>(memory.getRawBufferData()) + bytes_of(memory) - 1 - 4 - 1 - 6 * 8 - 4;
  ASSERT_EQ(std::vector<uint8_t>(count, count + 4), std::vector<uint8_t>(4, 0));
  count[1] = 0x4e;  // 19968
  memory.Seek(0);
  try {
    archive.ReadObject();
    ADD_FAILURE() << "no exception";
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr("19968 features, expected at most 2000"));
  }
}

TEST(LandmarkSubmap, DescribesAndShowsItself) {
  const LandmarkSubmap submap = twoFeatures();
  EXPECT_DOUBLE_EQ(submap.radius(), 5);
  std::ostringstream text;
  submap.getDescriptionAsText(text);
  EXPECT_THAT(text.str(), HasSubstr("Landmark submap 4"));
  EXPECT_THAT(text.str(), HasSubstr("2 within 5.0 m"));
  mrpt::opengl::CSetOfObjects view;
  submap.getVisualizationInto(view);
  EXPECT_EQ(view.size(), 6u) << "path, ellipse of the end pose, two of features, two corners";
}

TEST(LandmarkSubmap, OfARobotThatStoodStillIsUsableByTheFloor) {
  LandmarkSubmap submap = twoFeatures();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 7; ++j) submap.covariance(i, j) = submap.covariance(j, i) = 0;
  EXPECT_NO_THROW(requireUsable(submap));
  const auto floored = flooredCovariance(submap);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(floored(i, i), kLeastPoseVariance);
  EXPECT_EQ(floored(3, 3), 0.01);
}

TEST(LandmarkSubmap, WithoutFeaturesIsUsable) {
  LandmarkSubmap submap;
  submap.covariance.setIdentity(3);
  EXPECT_NO_THROW(requireUsable(submap));
}

TEST(LandmarkSubmap, ThatMakesNoSenseIsRefusedWithTheReason) {
  LandmarkSubmap submap = twoFeatures();
  submap.features[1].id = 7;
  EXPECT_THAT(refusal(submap), HasSubstr("feature 7 is there twice"));
  submap = twoFeatures();
  submap.features[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(submap), HasSubstr("not finite"));
  submap = twoFeatures();
  submap.covariance(3, 3) = -0.01;
  EXPECT_THAT(refusal(submap), HasSubstr("negative variance"));
  submap = twoFeatures();
  submap.covariance(4, 0) = submap.covariance(0, 4) = 0.02;  // a correlation of 2
  EXPECT_THAT(refusal(submap), HasSubstr("not positive definite"));
  submap = twoFeatures();
  submap.covariance(4, 0) = 0.001;
  EXPECT_THAT(refusal(submap), HasSubstr("not symmetric"));
  submap = twoFeatures();
  submap.covariance.setIdentity(5);
  EXPECT_THAT(refusal(submap), HasSubstr("5 x 5, expected 7 x 7"));
  submap = twoFeatures();
  submap.features.resize(kMostFeatures + 1);
  EXPECT_THAT(refusal(submap), HasSubstr("2001 features, expected at most 2000"));
}

TEST(AssociationErrors, CountWrongAndMissedMatches) {
  using Kind = FeatureAssociation::Kind;
  // Landmark 1 holds id 10 twice and once id 11; landmark 2 is id 10 again; landmark 3 is id 12.
  const std::vector<FeatureAssociation> associations{
      {0, 10, Kind::kNew, 1, 0},  {1, 10, Kind::kMatched, 1, 1}, {1, 11, Kind::kMatched, 1, 4},
      {2, 10, Kind::kNew, 2, 20}, {2, 12, Kind::kNew, 3, 90},    {3, 12, Kind::kDropped, 0, 10}};
  const AssociationErrors errors = compareWithIds(associations);
  EXPECT_EQ(errors.wrong, 1u);
  EXPECT_EQ(errors.missed, 1u);
  EXPECT_EQ(errors.dropped, 1u);
}

}  // namespace
}  // namespace submap_slam
