#include <fmt/format.h>
#include <mrpt/core/Clock.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>
#include <submap_slam/output/landmark_files.h>

#include <algorithm>
#include <cmath>

#include "binary_file.h"
#include "gzip_file.h"

namespace submap_slam {
namespace {

mrpt::opengl::CEllipsoid2D::Ptr ellipseAt(double x, double y, const mrpt::math::CMatrixDouble22& covariance) {
  auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
  ellipse->setQuantiles(3);
  ellipse->setCovMatrix(covariance);
  ellipse->setLocation(x, y, 0);
  return ellipse;
}

mrpt::opengl::CSetOfObjects::Ptr landmarkObjects(const std::vector<JoinedLandmark>& landmarks) {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  objects->setName("landmarks");
  for (const auto& landmark : landmarks) {
    auto ellipse = ellipseAt(landmark.x, landmark.y, landmark.covariance);
    ellipse->setColor_u8(0x14, 0x82, 0x46);
    ellipse->setName(fmt::format("{}", landmark.id));
    objects->insert(ellipse);
  }
  return objects;
}

mrpt::opengl::CSetOfLines::Ptr pathLine(const mrpt::poses::CPose2D& start, const Trajectory& path) {
  auto line = mrpt::opengl::CSetOfLines::Create();
  line->setColor_u8(0x20, 0x60, 0xd0);
  line->setLineWidth(2);
  mrpt::math::TPose2D before = start.asTPose();
  for (const auto& [stamp, pose] : path) {
    line->appendLine(before.x, before.y, 0, pose.x, pose.y, 0);
    before = pose;
  }
  return line;
}

mrpt::opengl::CSetOfObjects::Ptr frameObjects(const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  auto objects = mrpt::opengl::CSetOfObjects::Create();
  objects->setName("submaps");
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto& pose = frames[k].mean;
    auto corner = mrpt::opengl::stock_objects::CornerXYZSimple(0.5f, 1.0f);
    corner->setPose(pose);
    objects->insert(corner);
    if (k == 0) continue;
    auto ellipse = ellipseAt(pose.x(), pose.y(), frames[k].cov.extractMatrix<2, 2>(0, 0));
    ellipse->setColor_u8(0xd0, 0x30, 0x30);
    objects->insert(ellipse);
  }
  return objects;
}

}  // namespace

void writeLandmarks(const std::string& file, const std::vector<JoinedLandmark>& landmarks) {
  std::string text = "id,x,y,sxx,sxy,syy,hits\n";
  for (const auto& l : landmarks)
    text += fmt::format("{},{},{},{},{},{},{}\n", l.id, l.x, l.y, l.covariance(0, 0), l.covariance(0, 1),
                        l.covariance(1, 1), l.hits);
  writeBytes(file, text);
}

void writeFrames(const std::string& file, const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  std::string text = "stamp,x,y,phi,sxx,sxy,sxp,syy,syp,spp\n";
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const auto& mean = joined.frames[k + 1].mean;
    const auto& cov = joined.frames[k + 1].cov;
    const double stamp = submaps[k]->end_stamp == INVALID_TIMESTAMP
                             ? static_cast<double>(k + 1)
                             : mrpt::Clock::toDouble(submaps[k]->end_stamp);
    text += fmt::format("{:.6f},{},{},{},{},{},{},{},{},{}\n", stamp, mean.x(), mean.y(), mean.phi(),
                        cov(0, 0), cov(0, 1), cov(0, 2), cov(1, 1), cov(1, 2), cov(2, 2));
  }
  writeBytes(file, text);
}

void writeAssociations(const std::string& file, const std::vector<FeatureAssociation>& associations) {
  std::string text = "submap,feature,kind,landmark,distance2\n";
  for (const auto& a : associations) {
    const bool dropped = a.kind == FeatureAssociation::Kind::kDropped;
    text += fmt::format("{},{},{},{},{}\n", a.submap, a.feature, toString(a.kind),
                        dropped ? "" : fmt::format("{}", a.landmark),
                        std::isfinite(a.distance2) ? fmt::format("{:.6g}", a.distance2) : "");
  }
  writeBytes(file, text);
}

void writeLandmarkScene(const std::string& file, const JoinedLandmarks& joined, const Trajectory& path) {
  mrpt::opengl::COpenGLScene scene;
  scene.insert(landmarkObjects(joined.landmarks));
  scene.insert(frameObjects(joined.frames));
  scene.insert(pathLine(joined.frames.front().mean, path));
  writeGzippedArchive(file, scene);
}

}  // namespace submap_slam
