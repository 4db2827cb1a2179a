#include <mrpt/math/wrap2pi.h>
#include <submap_slam/eval/nees.h>

#include <Eigen/Cholesky>
#include <stdexcept>

namespace submap_slam {

std::optional<double> nees(const mrpt::poses::CPosePDFGaussian& estimate, const mrpt::math::TPose2D& truth) {
  const Eigen::Vector3d error(estimate.mean.x() - truth.x, estimate.mean.y() - truth.y,
                              mrpt::math::wrapToPi(estimate.mean.phi() - truth.phi));
  const Eigen::Matrix3d covariance = estimate.cov.asEigen();
  const Eigen::LLT<Eigen::Matrix3d> cholesky(covariance);
  if (!covariance.allFinite() || cholesky.info() != Eigen::Success) return {};
  return error.dot(cholesky.solve(error));
}

NeesResult meanNees(const std::vector<mrpt::poses::CPosePDFGaussian>& estimates,
                    const std::vector<mrpt::math::TPose2D>& truth) {
  if (estimates.size() != truth.size())
    throw std::invalid_argument("meanNees: as many true poses as estimates are needed");
  NeesResult result;
  double sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto value = nees(estimates[i], truth[i]);
    sum += value.value_or(0);
    ++(value ? result.used : result.skipped);
  }
  if (result.used > 0) result.mean = sum / static_cast<double>(result.used);
  return result;
}

}  // namespace submap_slam
