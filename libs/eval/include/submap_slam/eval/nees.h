/** Normalised estimation error squared, the test of whether covariances are honest (Bar-Shalom, Li,
 * Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, sec. 5.4.2). */
#pragma once

#include <mrpt/math/TPose2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <optional>
#include <vector>

namespace submap_slam {

/** eᵀ Σ⁻¹ e with e = estimate − truth (x, y, wrapped heading); χ² with 3 degrees of freedom if the covariance
 * is honest. Nothing if the covariance is not positive definite. */
std::optional<double> nees(const mrpt::poses::CPosePDFGaussian& estimate, const mrpt::math::TPose2D& truth);

struct NeesResult {
  std::size_t used = 0;  ///< samples in the mean
  std::size_t skipped =
      0;            ///< samples whose covariance is not positive definite, such as a fixed first frame
  double mean = 0;  ///< 3 is expected; above: overconfident, below: underconfident
};

/** Mean over samples; throws std::invalid_argument if the sizes differ. */
NeesResult meanNees(const std::vector<mrpt::poses::CPosePDFGaussian>& estimates,
                    const std::vector<mrpt::math::TPose2D>& truth);

}  // namespace submap_slam
