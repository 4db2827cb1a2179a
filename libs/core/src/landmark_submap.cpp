#include <submap_slam/core/landmark_submap.h>

#include <fmt/format.h>
#include <mrpt/core/Clock.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>
#include <submap_slam/core/errors.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

IMPLEMENTS_SERIALIZABLE(LandmarkSubmap, mrpt::obs::CObservation, submap_slam)

namespace submap_slam {
namespace {

using mrpt::math::CMatrixDouble;
using mrpt::serialization::CArchive;

/** The lower triangle row by row; the rest follows from it. */
void writeSymmetric(CArchive& out, const CMatrixDouble& matrix) {
  const auto size = static_cast<std::size_t>(matrix.rows());
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column <= row; ++column) out << matrix(row, column);
}

CMatrixDouble readSymmetric(CArchive& in, std::size_t size) {
  CMatrixDouble matrix(size, size);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column <= row; ++column) {
      in >> matrix(row, column);
      matrix(column, row) = matrix(row, column);
    }
  return matrix;
}

mrpt::opengl::CEllipsoid2D::Ptr ellipseOf(const CMatrixDouble& covariance, int first, double x, double y) {
  auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
  ellipse->setColor_u8(0xd0, 0x30, 0x30);
  ellipse->setQuantiles(3);
  ellipse->setCovMatrix(covariance.extractMatrix(2, 2, first, first));
  ellipse->setLocation(x, y, 0);
  return ellipse;
}

bool isFinite(const LandmarkSubmap& submap) {
  const auto& end = submap.end_pose;
  return std::isfinite(end.x) && std::isfinite(end.y) && std::isfinite(end.phi) &&
         submap.covariance.asEigen().allFinite() &&
         std::all_of(submap.features.begin(), submap.features.end(),
                     [](const SubmapFeature& f) { return std::isfinite(f.x) && std::isfinite(f.y); }) &&
         std::all_of(submap.nodes.begin(), submap.nodes.end(), [](const LandmarkNode& n) {
           return std::isfinite(n.pose.x) && std::isfinite(n.pose.y) && std::isfinite(n.pose.phi);
         });
}

void requireFewEnough(std::size_t features) {
  if (features > kMostFeatures)
    throw InputError(fmt::format("it has {} features, expected at most {}", features, kMostFeatures));
}

void requireDifferentIds(const LandmarkSubmap& submap) {
  std::vector<uint32_t> ids;
  for (const auto& feature : submap.features) ids.push_back(feature.id);
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  if (twice != ids.end())
    throw InputError(fmt::format("feature {} is there twice; ids must differ within a submap", *twice));
}

}  // namespace

uint8_t LandmarkSubmap::serializeGetVersion() const { return 1; }

void LandmarkSubmap::serializeTo(CArchive& out) const {
  if (static_cast<std::size_t>(covariance.rows()) != dimension() ||
      static_cast<std::size_t>(covariance.cols()) != dimension())
    throw std::logic_error("a LandmarkSubmap cannot be written: its covariance has the wrong size");
  out << sensorLabel << timestamp << id << end_stamp;
  out << end_pose.x << end_pose.y << end_pose.phi << static_cast<uint32_t>(features.size());
  for (const auto& f : features) out << f.id << f.x << f.y << f.hits;
  writeSymmetric(out, covariance);
  out << ids_known << static_cast<uint32_t>(nodes.size());
  for (const auto& node : nodes) out << node.stamp << node.pose.x << node.pose.y << node.pose.phi;
}

void LandmarkSubmap::serializeFrom(CArchive& in, uint8_t version) {
  if (version > 1) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> sensorLabel >> timestamp >> id >> end_stamp;
  in >> end_pose.x >> end_pose.y >> end_pose.phi;
  const auto count = in.ReadAs<uint32_t>();
  requireFewEnough(count);
  features.resize(count);
  for (auto& f : features) in >> f.id >> f.x >> f.y >> f.hits;
  covariance = readSymmetric(in, dimension());
  ids_known = true;
  nodes.clear();
  if (version == 0) return;
  in >> ids_known;
  const auto node_count = in.ReadAs<uint32_t>();
  for (uint32_t k = 0; k < node_count; ++k) {
    LandmarkNode node;
    in >> node.stamp >> node.pose.x >> node.pose.y >> node.pose.phi;
    nodes.push_back(node);
  }
}

double LandmarkSubmap::radius() const {
  double radius = 0;
  for (const auto& f : features) radius = std::max(radius, std::hypot(f.x, f.y));
  return radius;
}

void LandmarkSubmap::getSensorPose(mrpt::poses::CPose3D& pose) const { pose = mrpt::poses::CPose3D(); }

void LandmarkSubmap::setSensorPose(const mrpt::poses::CPose3D&) {
  throw std::logic_error("a LandmarkSubmap has no sensor pose; its frame is the robot pose at its start");
}

void LandmarkSubmap::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  const auto sigma = [this](std::size_t i) { return std::sqrt(covariance(i, i)); };
  out << fmt::format(
      "\nLandmark submap {}\n"
      "  features     : {} within {:.1f} m\n"
      "  end pose     : x {:.3f} m, y {:.3f} m, heading {:.2f} deg\n"
      "  its 1-sigma  : x {:.4f} m, y {:.4f} m, heading {:.3f} deg\n",
      id, features.size(), radius(), end_pose.x, end_pose.y, mrpt::RAD2DEG(end_pose.phi), sigma(0), sigma(1),
      mrpt::RAD2DEG(sigma(2)));
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto& f = features[i];
    const std::size_t row = 3 + 2 * i;
    out << fmt::format("  feature {:>6} : x {:.3f} m ± {:.3f}, y {:.3f} m ± {:.3f}, {} hits\n", f.id, f.x,
                       sigma(row), f.y, sigma(row + 1), f.hits);
  }
}

std::string LandmarkSubmap::exportTxtHeader() const { return "id features end_x_m end_y_m end_phi_rad"; }

std::string LandmarkSubmap::exportTxtDataRow() const {
  return fmt::format("{} {} {:.9g} {:.9g} {:.9g}", id, features.size(), end_pose.x, end_pose.y, end_pose.phi);
}

void LandmarkSubmap::getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const {
  out.clear();
  auto path = mrpt::opengl::CSetOfLines::Create();
  path->setColor_u8(0x20, 0x60, 0xd0);
  path->setLineWidth(2);
  path->appendLine(0, 0, 0, end_pose.x, end_pose.y, 0);
  out.insert(path);
  out.insert(ellipseOf(covariance, 0, end_pose.x, end_pose.y));
  for (std::size_t i = 0; i < features.size(); ++i)
    out.insert(ellipseOf(covariance, 3 + 2 * static_cast<int>(i), features[i].x, features[i].y));
  out.insert(mrpt::opengl::stock_objects::CornerXYZSimple(1.0f));
  auto end = mrpt::opengl::stock_objects::CornerXYZSimple(0.5f);
  end->setPose(end_pose);
  out.insert(end);
}

CMatrixDouble flooredCovariance(const LandmarkSubmap& submap) {
  CMatrixDouble covariance = submap.covariance;
  for (std::size_t i = 0; i < 3; ++i) covariance(i, i) = std::max(covariance(i, i), kLeastPoseVariance);
  return covariance;
}

void requireUsable(const LandmarkSubmap& submap) {
  requireFewEnough(submap.features.size());
  const auto size = static_cast<int>(submap.dimension());
  if (submap.covariance.rows() != size || submap.covariance.cols() != size)
    throw InputError(fmt::format("its covariance is {} x {}, expected {} x {}", submap.covariance.rows(),
                                 submap.covariance.cols(), size, size));
  if (!isFinite(submap)) throw InputError("it holds a number that is not finite");
  requireDifferentIds(submap);
  const auto negative = [](double variance) { return variance < 0; };
  const Eigen::VectorXd variances = submap.covariance.asEigen().diagonal();
  if (std::any_of(variances.begin(), variances.end(), negative))
    throw InputError("its covariance has a negative variance");
  const Eigen::MatrixXd covariance = flooredCovariance(submap).asEigen();
  if (!covariance.isApprox(covariance.transpose(), 1e-9)) throw InputError("its covariance is not symmetric");
  if (covariance.llt().info() != Eigen::Success) throw InputError("its covariance is not positive definite");
}

}  // namespace submap_slam
