#include <gmock/gmock.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/grid_submap.h>

#include <Eigen/Core>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace submap_slam {
namespace {

using ::testing::HasSubstr;

mrpt::obs::CObservation2DRangeScan::Ptr sampleScan() {
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->aperture = 1.5f;
  scan->rightToLeft = false;
  scan->resizeScanAndAssign(3, 2.5f, true);
  scan->setScanRange(1, 4.75f);
  return scan;
}

GridSubmap::Ptr sampleSubmap() {
  auto submap = GridSubmap::Create();
  submap->sensorLabel = "SUBMAP";
  submap->timestamp = mrpt::Clock::fromDouble(1.5e9);
  submap->id = 4;
  submap->first_frame = 5'000'000'000;
  submap->end_frame = 5'000'000'003;
  submap->evidence = EvidenceGrid(-1, 2, -1, 1, 0.1);
  *submap->evidence.log_odds.cellByPos(1.25, -0.35) = 3.5f;
  *submap->evidence.hits.cellByPos(1.25, -0.35) = 2;
  submap->nodes.resize(3);
  submap->nodes[0].scans = {sampleScan(), sampleScan()};
  submap->nodes[0].odometry = mrpt::math::TPose2D(10, 20, 3);
  submap->nodes[1].pose = {0.3, 0.4, 0.1};
  submap->nodes[1].stamp = mrpt::Clock::fromDouble(1.5e9 + 1);
  submap->nodes[2].pose = {0.3, 1.0 / 3, -0.1};
  submap->end_pose.mean = mrpt::poses::CPose2D(0.7, 0.2, 1.0 / 7);
  submap->end_pose.cov(0, 0) = 1e-4;
  submap->end_pose.cov(1, 1) = 4e-4;
  submap->end_pose.cov(2, 2) = 1.0 / 3e5;
  submap->end_pose.cov(0, 2) = submap->end_pose.cov(2, 0) = 1e-6;
  submap->has_successor = true;
  submap->statistics.match_score_mean = 0.9f;
  submap->statistics.match_score_min = 0.5f;
  submap->statistics.match_score_max = 1.0f;
  submap->statistics.rescues = 2;
  submap->statistics.max_particles = 5;
  submap->statistics.resamplings = 7;
  submap->statistics.ambiguous_scans = 11;
  submap->statistics.closed_because = "stretch ended";
  return submap;
}

std::vector<uint8_t> bytesOf(const GridSubmap& submap) {
  std::vector<uint8_t> bytes;
  mrpt::serialization::ObjectToOctetVector(&submap, bytes);
  return bytes;
}

GridSubmap::Ptr readBack(const std::vector<uint8_t>& bytes) {
  mrpt::serialization::CSerializable::Ptr object;
  mrpt::serialization::OctetVectorToObject(bytes, object);
  return std::dynamic_pointer_cast<GridSubmap>(object);
}

TEST(GridSubmap, ReadsBackEveryMember) {
  const auto submap = sampleSubmap();
  const auto back = readBack(bytesOf(*submap));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->sensorLabel, "SUBMAP");
  EXPECT_EQ(back->timestamp, submap->timestamp);
  EXPECT_EQ(back->id, 4u);
  EXPECT_EQ(back->first_frame, 5'000'000'000u);
  EXPECT_EQ(back->end_frame, 5'000'000'003u);
  const LoadedEvidence evidence(*back);
  EXPECT_EQ(evidence->log_odds.data(), submap->evidence.log_odds.data());
  EXPECT_EQ(evidence->hits.data(), submap->evidence.hits.data());
  EXPECT_EQ(back->end_pose.mean.asTPose(), submap->end_pose.mean.asTPose());
  EXPECT_EQ(back->end_pose.cov.asEigen(), submap->end_pose.cov.asEigen());
  EXPECT_TRUE(back->has_successor);
}

TEST(GridSubmap, ReadsBackNodesAndScans) {
  const auto submap = sampleSubmap();
  const auto back = readBack(bytesOf(*submap));
  ASSERT_EQ(back->nodes.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back->nodes[i].stamp, submap->nodes[i].stamp);
    EXPECT_EQ(back->nodes[i].pose, submap->nodes[i].pose);
    EXPECT_EQ(back->nodes[i].odometry, submap->nodes[i].odometry);
    EXPECT_EQ(back->nodes[i].isKey(), i == 0);
  }
  ASSERT_EQ(back->nodes[0].scans.size(), 2u);
  EXPECT_EQ(back->nodes[0].scans[1]->getScanRange(1), 4.75f);
  EXPECT_FALSE(back->nodes[0].scans[1]->rightToLeft);
}

TEST(GridSubmap, ReadsBackItsStatistics) {
  const SubmapStatistics back = readBack(bytesOf(*sampleSubmap()))->statistics;
  EXPECT_EQ(back.match_score_mean, 0.9f);
  EXPECT_EQ(back.match_score_min, 0.5f);
  EXPECT_EQ(back.match_score_max, 1.0f);
  EXPECT_EQ(back.rescues, 2u);
  EXPECT_EQ(back.max_particles, 5u);
  EXPECT_EQ(back.resamplings, 7u);
  EXPECT_EQ(back.ambiguous_scans, 11u);
  EXPECT_EQ(back.closed_because, "stretch ended");
}

TEST(GridSubmap, WritesTheSameBytesAgain) {
  const auto bytes = bytesOf(*sampleSubmap());
  EXPECT_EQ(bytesOf(*readBack(bytes)), bytes);
}

TEST(GridSubmap, IsAnObservationToStockPrograms) {
  const mrpt::obs::CObservation::Ptr observation = sampleSubmap();
  EXPECT_STREQ(observation->GetRuntimeClass()->className, "submap_slam::GridSubmap");
  EXPECT_NE(mrpt::rtti::classFactory("submap_slam::GridSubmap"), nullptr);
  mrpt::poses::CPose3D sensor(1, 2, 3);
  observation->getSensorPose(sensor);
  EXPECT_EQ(sensor, mrpt::poses::CPose3D());
  EXPECT_THROW(observation->setSensorPose(sensor), std::logic_error);
}

TEST(GridSubmap, ATruncatedSubmapIsRefused) {
  const auto bytes = bytesOf(*sampleSubmap());
  for (const double share : {0.2, 0.5, 0.9, 0.999}) {
    mrpt::io::CMemoryStream stream;
    stream.Write(bytes.data(), static_cast<std::size_t>(share * static_cast<double>(bytes.size())));
    stream.Seek(0);
    auto archive = mrpt::serialization::archiveFrom(stream);
    EXPECT_ANY_THROW(archive.ReadObject()) << share;
  }
}

TEST(GridSubmap, MeasuresItsRadiusAndPath) {
  const auto submap = sampleSubmap();
  EXPECT_NEAR(submap->radius(), std::hypot(1.25, 0.35), 1e-6);
  EXPECT_NEAR(submap->pathLength(), 0.5 + 0.4 - 1.0 / 3, 1e-12);
  EXPECT_EQ(submap->keyNodes(), 1u);
  const auto empty = GridSubmap::Create();
  EXPECT_EQ(empty->radius(), 0);
  EXPECT_EQ(empty->pathLength(), 0);
  EXPECT_EQ(empty->keyNodes(), 0u);
}

TEST(GridSubmap, DescribesItselfInWords) {
  std::ostringstream text;
  sampleSubmap()->getDescriptionAsText(text);
  EXPECT_THAT(text.str(), HasSubstr("Grid submap 4\n"));
  EXPECT_THAT(text.str(), HasSubstr("5000000000 to 5000000003"));
  EXPECT_THAT(text.str(), HasSubstr("3 (1 with scans), path 0.57 m"));
  EXPECT_THAT(text.str(), HasSubstr("30 x 20 cells of 0.100 m, 1 observed"));
  EXPECT_THAT(text.str(), HasSubstr("x 0.0100 m, y 0.0200 m, heading 0.105 deg"));
  EXPECT_THAT(text.str(), HasSubstr("stretch ended"));
}

TEST(GridSubmap, ExportsOneColumnForEachTitle) {
  const auto submap = sampleSubmap();
  const auto words = [](const std::string& line) {
    std::istringstream in(line);
    return std::vector<std::string>(std::istream_iterator<std::string>(in), {});
  };
  ASSERT_TRUE(submap->exportTxtSupported());
  const auto row = words(submap->exportTxtDataRow());
  EXPECT_EQ(row.size(), words(submap->exportTxtHeader()).size());
  EXPECT_EQ(row[1], "5000000000");
  EXPECT_EQ(row[6], "1");
  EXPECT_EQ(row[7], "0.7");
}

TEST(GridSubmap, DrawsGridAndPathInItsOwnFrame) {
  mrpt::opengl::CSetOfObjects scene;
  const auto submap = sampleSubmap();
  submap->getVisualizationInto(scene);
  const auto path = scene.getByClass<mrpt::opengl::CSetOfLines>();
  ASSERT_TRUE(path);
  EXPECT_EQ(path->getLineCount(), 2u);
  const std::size_t objects = scene.size();
  submap->getVisualizationInto(scene);
  EXPECT_EQ(scene.size(), objects) << "drawing again replaces";
}

}  // namespace
}  // namespace submap_slam
