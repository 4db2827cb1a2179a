#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/output/mrpt_files.h>

#include <cmath>
#include <stdexcept>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

SubmapNode node(double t, const mrpt::math::TPose2D& pose, bool key) {
  SubmapNode n;
  n.stamp = mrpt::Clock::fromDouble(t);
  n.pose = pose;
  if (!key) return n;
  auto scan = mrpt::obs::CObservation2DRangeScan::Create();
  scan->timestamp = n.stamp;
  scan->sensorLabel = "FRONT";
  scan->resizeScan(3);
  for (std::size_t i = 0; i < 3; ++i) scan->setScanRange(i, 1.5f), scan->setScanRangeValidity(i, true);
  n.scans.push_back(scan);
  return n;
}

/** Two submaps with two key nodes and one other in all. */
GridSubmaps sampleSubmaps() {
  GridSubmaps submaps{GridSubmap::Create(), GridSubmap::Create()};
  submaps[0]->nodes = {node(1000, {0, 0, 0}, true), node(1001, {1, 0, 0}, false)};
  submaps[1]->nodes = {node(1002, {2, 0, 0.3}, true)};
  return submaps;
}

}  // namespace

JoinedMap withFrames(const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  JoinedMap joined;
  joined.frames = frames;
  return joined;
}

TEST(WriteGridMap, MrptReadsTheSameGrid) {
  const TempFolder folder;
  writeGridMap(folder.file("map.gridmap.gz"), sampleGrid());
  mrpt::io::CFileGZInputStream in(folder.file("map.gridmap.gz"));
  mrpt::maps::COccupancyGridMap2D map;
  mrpt::serialization::archiveFrom(in) >> map;
  EXPECT_EQ(map.getSizeX(), 4u);
  EXPECT_EQ(map.getSizeY(), 3u);
  EXPECT_FLOAT_EQ(map.getXMin(), -1);
  EXPECT_LT(map.getPos(-0.75f, 2.25f), 0.1f);
  EXPECT_GT(map.getPos(-0.25f, 2.25f), 0.9f);
  EXPECT_NEAR(map.getPos(0.75f, 2.25f), 0.5f, 1e-3f);
}

TEST(WriteGridMap, MrptReadsALargeGridThatIsCompressedInPieces) {
  const TempFolder folder;
  PackedEvidence large(0, 150, 0, 160, 0.1);  // 2.4 MB
  for (int k = 0; k < 1500; ++k) large.set(k, k, k % 2 == 0 ? 4 : -4, 1);
  writeGridMap(folder.file("large.gridmap.gz"), large);
  mrpt::io::CFileGZInputStream in(folder.file("large.gridmap.gz"));
  mrpt::maps::COccupancyGridMap2D map;
  mrpt::serialization::archiveFrom(in) >> map;
  const auto expected = large.toOccupancyGrid();
  ASSERT_EQ(map.getSizeX(), expected.getSizeX());
  EXPECT_EQ(map.getRawMap(), expected.getRawMap());
}

TEST(WriteGridMap, GzipHeaderHasNoTime) {
  const TempFolder folder;
  writeGridMap(folder.file("map.gridmap.gz"), sampleGrid());
  const auto bytes = readAll(folder.file("map.gridmap.gz"));
  EXPECT_EQ(bytes.substr(0, 3), "\x1f\x8b\x08");
  EXPECT_EQ(bytes.substr(3, 5), std::string(5, '\0'));  // no name, time 0
}

TEST(WriteSimpleMap, HoldsTheScansOfKeyNodesAtTheirGlobalPoses) {
  const TempFolder folder;
  writeSimpleMap(folder.file("a.simplemap"), sampleSubmaps(),
                 withFrames({gaussian(0, 0, 0), gaussian(10, 5, M_PI / 2)}));
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile(folder.file("a.simplemap")));
  ASSERT_EQ(map.size(), 2u);
  const auto [pdf, scans] = map.get(1);
  const auto gaussian3d = std::dynamic_pointer_cast<mrpt::poses::CPose3DPDFGaussian>(pdf);
  ASSERT_TRUE(gaussian3d);
  EXPECT_NEAR(gaussian3d->mean.x(), 10, 1e-9);
  EXPECT_NEAR(gaussian3d->mean.y(), 7, 1e-9);
  EXPECT_NEAR(gaussian3d->mean.yaw(), M_PI / 2 + 0.3, 1e-9);
  ASSERT_EQ(scans->size(), 1u);
  const auto scan = scans->getObservationByIndexAs<mrpt::obs::CObservation2DRangeScan::Ptr>(0);
  EXPECT_EQ(scan->sensorLabel, "FRONT");
  EXPECT_EQ(scan->timestamp, mrpt::Clock::fromDouble(1002));
}

TEST(WriteSimpleMap, HeadingOfTheFrameIsUncertaintyOfAFarNodesPosition) {
  const TempFolder folder;
  writeSimpleMap(folder.file("a.simplemap"), sampleSubmaps(),
                 withFrames({gaussian(0, 0, 0), gaussian(10, 5, 0)}));
  mrpt::maps::CSimpleMap map;
  ASSERT_TRUE(map.loadFromFile(folder.file("a.simplemap")));
  const auto cov = std::dynamic_pointer_cast<mrpt::poses::CPose3DPDFGaussian>(std::get<0>(map.get(1)))->cov;
  // The node is 2 m ahead: y gets (2 m)² times the variance of the heading, 0.0025 rad².
  EXPECT_NEAR(cov(0, 0), 0.04, 1e-9);
  EXPECT_NEAR(cov(1, 1), 0.01 + 4 * 0.0025, 1e-9);
  EXPECT_NEAR(cov(3, 3), 0.0025, 1e-9);
  EXPECT_NEAR(cov(1, 3), 2 * 0.0025, 1e-9);
}

TEST(WriteSimpleMap, NeedsOneFrameForEachSubmap) {
  const TempFolder folder;
  EXPECT_THROW(writeSimpleMap(folder.file("a.simplemap"), sampleSubmaps(), withFrames({gaussian(0, 0, 0)})),
               std::invalid_argument);
}

TEST(WriteScene, MrptFindsMapTrajectoryAndFrames) {
  const TempFolder folder;
  writeScene(folder.file("a.3Dscene"), sampleGrid(), sampleTrajectory(), sampleFrames());
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(folder.file("a.3Dscene")));
  EXPECT_TRUE(scene.getByName("map"));
  const auto line = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(scene.getByName("trajectory"));
  ASSERT_TRUE(line);
  EXPECT_EQ(line->getLineCount(), 2u);
  const auto second = scene.getByName("1");
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->getPose().x, 0.5, 1e-6);
  EXPECT_NEAR(second->getPose().yaw, 0.6, 1e-6);
  EXPECT_FALSE(scene.getByName("2"));
}

TEST(WriteScene, FixedFramesAndEmptyResultsAreFine) {
  const TempFolder folder;
  const CPosePDFGaussian fixed(mrpt::poses::CPose2D(), mrpt::math::CMatrixDouble33::Zero());
  writeScene(folder.file("a.3Dscene"), PackedEvidence(), {}, {fixed});
  mrpt::opengl::COpenGLScene scene;
  EXPECT_TRUE(scene.loadFromFile(folder.file("a.3Dscene")));
}

TEST(MrptFiles, SameResultsGiveTheSameBytes) {
  const TempFolder folder;
  for (const char* run : {"1", "2"}) {
    writeGridMap(folder.file(std::string(run) + ".gridmap.gz"), sampleGrid());
    writeSimpleMap(folder.file(std::string(run) + ".simplemap"), sampleSubmaps(), withFrames(sampleFrames()));
    writeScene(folder.file(std::string(run) + ".3Dscene"), sampleGrid(), sampleTrajectory(), sampleFrames());
  }
  for (const char* kind : {".gridmap.gz", ".simplemap", ".3Dscene"})
    EXPECT_EQ(readAll(folder.file(std::string("1") + kind)), readAll(folder.file(std::string("2") + kind)))
        << kind;
}

}  // namespace submap_slam
