#include <fmt/format.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation3DScene.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <submap_slam/output/mrpt_files.h>

#include <stdexcept>

#include "gzip_file.h"

namespace submap_slam {
namespace {

using mrpt::poses::CPosePDFGaussian;

/** T_w_node with the uncertainty of T_w_s; the node in its submap counts as exact. */
CPosePDFGaussian nodePose(const CPosePDFGaussian& frame, const mrpt::math::TPose2D& T_s_node) {
  CPosePDFGaussian pose = frame;
  // The overload for a plain pose leaves out the lever arm.
  pose += CPosePDFGaussian(mrpt::poses::CPose2D(T_s_node), mrpt::math::CMatrixDouble33::Zero());
  return pose;
}

void insertKeyNodes(const GridSubmap& submap, const std::vector<mrpt::math::TPose2D>& nodes,
                    const CPosePDFGaussian& frame, mrpt::maps::CSimpleMap& map) {
  const std::vector<SubmapScans> scans = submap.scans();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].empty()) continue;
    const auto observations = mrpt::obs::CSensoryFrame::Create();
    for (const auto& scan : scans[i]) observations->insert(scan);
    map.insert(mrpt::poses::CPose3DPDFGaussian::Create(nodePose(frame, nodes[i])), observations);
  }
}

mrpt::opengl::CSetOfObjects::Ptr gridObject(const PackedEvidence& map) {
  auto grid = mrpt::opengl::CSetOfObjects::Create();
  map.toOccupancyGrid().getVisualizationInto(*grid);
  grid->setName("map");
  return grid;
}

mrpt::opengl::CSetOfLines::Ptr trajectoryObject(const Trajectory& trajectory) {
  auto line = mrpt::opengl::CSetOfLines::Create();
  line->setName("trajectory");
  line->setColor_u8(0x20, 0x60, 0xd0);
  line->setLineWidth(2);
  constexpr double kAboveGrid_m = 0.15;  // seen from afar too
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const auto &a = trajectory[i - 1].pose, &b = trajectory[i].pose;
    line->appendLine(a.x, a.y, kAboveGrid_m, b.x, b.y, kAboveGrid_m);
  }
  return line;
}

mrpt::opengl::CSetOfObjects::Ptr frameObject(std::size_t id, const CPosePDFGaussian& frame) {
  auto corner = mrpt::opengl::stock_objects::CornerXYZSimple(1.0f, 2.0f);
  corner->setName(fmt::format("{}", id));
  corner->setPose(frame.mean);
  // The label that an object can show for its name is white, invisible on free space.
  auto label = mrpt::opengl::CText::Create(corner->getName());
  label->setColor_u8(0xd0, 0x30, 0x30);
  label->setLocation(0.1, 0.1, 0.5);
  corner->insert(label);
  return corner;
}

mrpt::opengl::CEllipsoid2D::Ptr ellipseObject(const CPosePDFGaussian& frame) {
  constexpr double kAboveGrid_m = 0.16;
  auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
  ellipse->setColor_u8(0xd0, 0x30, 0x30);
  ellipse->setQuantiles(3);
  ellipse->setCovMatrix(mrpt::math::CMatrixDouble22(frame.cov.blockCopy<2, 2>(0, 0)));
  ellipse->setLocation(frame.mean.x(), frame.mean.y(), kAboveGrid_m);
  return ellipse;
}

/** What writeScene and writeSceneLog write. */
mrpt::opengl::COpenGLScene::Ptr mapScene(const PackedEvidence& map, const Trajectory& trajectory,
                                         const std::vector<CPosePDFGaussian>& frames) {
  auto scene = mrpt::opengl::COpenGLScene::Create();
  scene->insert(gridObject(map));
  scene->insert(trajectoryObject(trajectory));
  auto submaps = mrpt::opengl::CSetOfObjects::Create();
  submaps->setName("submaps");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    submaps->insert(frameObject(i, frames[i]));
    submaps->insert(ellipseObject(frames[i]));
  }
  scene->insert(submaps);
  return scene;
}

}  // namespace

void writeGridMap(const std::string& file, const PackedEvidence& map) {
  writeGzippedArchive(file, map.toOccupancyGrid());
}

void writeSimpleMap(const std::string& file, const GridSubmaps& submaps, const JoinedMap& joined) {
  if (submaps.size() != joined.frames.size())
    throw std::invalid_argument("writeSimpleMap: one frame for each submap is needed");
  mrpt::maps::CSimpleMap map;
  for (std::size_t i = 0; i < submaps.size(); ++i)
    insertKeyNodes(*submaps[i], nodePosesOf(submaps, joined, i), joined.frames[i], map);
  writeGzippedArchive(file, map);
}

void writeScene(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                const std::vector<CPosePDFGaussian>& frames) {
  writeGzippedArchive(file, *mapScene(map, trajectory, frames));
}

void writeSceneLog(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                   const std::vector<CPosePDFGaussian>& frames) {
  mrpt::obs::CObservation3DScene observation;
  observation.timestamp = trajectory.empty() ? INVALID_TIMESTAMP : trajectory.back().stamp;
  observation.scene = mapScene(map, trajectory, frames);
  writeGzippedArchive(file, observation);
}

}  // namespace submap_slam
