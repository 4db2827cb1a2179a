#include <submap_slam/eval/submap_nees.h>

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Of a submap with a true end: the errors of those elements of the state that have a truth, and their places
 * in the state. */
struct StateError {
  std::vector<double> values;
  std::vector<Eigen::Index> elements;

  void add(double error, std::size_t element) {
    values.push_back(error);
    elements.push_back(static_cast<Eigen::Index>(element));
  }
};

StateError stateError(const LandmarkSubmap& submap, const LandmarkTruth& landmarks, const TPose2D& T_w_s,
                      const TPose2D& T_w_end) {
  const TPose2D wanted = T_w_end - T_w_s;
  StateError error;
  error.add(submap.end_pose.x - wanted.x, 0);
  error.add(submap.end_pose.y - wanted.y, 1);
  error.add(mrpt::math::wrapToPi(submap.end_pose.phi - wanted.phi), 2);
  for (std::size_t i = 0; i < submap.features.size(); ++i) {
    const SubmapFeature& feature = submap.features[i];
    const auto known = landmarks.find(feature.id);
    if (!submap.ids_known || known == landmarks.end()) continue;
    const auto place = T_w_s.inverseComposePoint(known->second);
    error.add(feature.x - place.x, 3 + 2 * i);
    error.add(feature.y - place.y, 4 + 2 * i);
  }
  return error;
}

}  // namespace

std::optional<double> neesPerDimension(const LandmarkSubmap& submap, const LandmarkTruth& landmarks,
                                       const TimedTrajectory& path) {
  if (submap.timestamp == INVALID_TIMESTAMP || submap.end_stamp == INVALID_TIMESTAMP) return {};
  const auto T_w_s = path.at(mrpt::Clock::toDouble(submap.timestamp));
  const auto T_w_end = path.at(mrpt::Clock::toDouble(submap.end_stamp));
  if (!T_w_s || !T_w_end) return {};
  const StateError error = stateError(submap, landmarks, toPose2D(*T_w_s), toPose2D(*T_w_end));
  const auto size = static_cast<Eigen::Index>(error.values.size());
  const Eigen::Map<const Eigen::VectorXd> e(error.values.data(), size);
  const Eigen::MatrixXd covariance = submap.covariance.asEigen()(error.elements, error.elements);
  const Eigen::LLT<Eigen::MatrixXd> cholesky(covariance);
  if (!covariance.allFinite() || cholesky.info() != Eigen::Success) return {};
  return e.dot(cholesky.solve(e)) / static_cast<double>(size);
}

SubmapNees meanNeesPerDimension(const LandmarkSubmaps& submaps, const LandmarkTruth& landmarks,
                                const TimedTrajectory& path) {
  SubmapNees result;
  double sum = 0;
  for (const auto& submap : submaps)
    if (const auto nees = neesPerDimension(*submap, landmarks, path)) sum += *nees, ++result.used;
  if (result.used > 0) result.mean = sum / static_cast<double>(result.used);
  return result;
}

}  // namespace submap_slam
