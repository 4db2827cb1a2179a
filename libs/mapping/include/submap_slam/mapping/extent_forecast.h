#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/mapping/drift_covariance.h>
#include <submap_slam/mapping/grid_mapper.h>

#include <cstddef>

namespace submap_slam {

/** What a submap will be like if it goes on to the frame taken last, foretold before anything is matched,
 * from odometry and the geometry of each scan alone.
 *
 * **Blur.** DriftCovariance gives the covariance P that the robot's pose will have, with the information that
 * a scan of this form has if each beam is matched to a line with the normal that the scan itself shows,
 * H = Σ_b j_b j_bᵀ / σ², j_b = (n_b, p_b × n_b). Drift along a featureless corridor moves no surface visibly,
 * so what counts is how far it moves the surfaces that are in sight along their normals, as root mean square,
 *
 *     blur² = 1/B Σ_b j_bᵀ P j_b = σ² tr(P H) / B.
 *
 * **Overlap.** A submap shows what lies within sight R of its path of length d, and its neighbour as much:
 * they share about R / (R + d) of it. */
class ExtentForecast {
 public:
  explicit ExtentForecast(const GridMapperParams& mapper);

  /** The submap's first frame. */
  void begin(const Frame& first);

  /** The next frame of the submap. Without odometry the robot is taken to stand still. */
  void add(const Frame& frame);

  /** m */
  double blur() const;

  /** Share of its area that the submap shares with the next one of the same length, (0, 1]. */
  double overlap() const;

 private:
  /** H in the robot's axes, and B: beams whose normal is known. */
  struct ScanInformation {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    double beams = 0;
  };
  ScanInformation informationOf(const LaserPoints& scan) const;
  void addKeyScan(const Frame& frame);

  GridMapperParams mapper_;
  DriftCovariance drift_;
  std::optional<mrpt::math::TPose2D> T_odom_start_;
  mrpt::math::TPose2D pose_, key_pose_;  ///< T_start_robot by odometry, now and at the last key scan
  ScanInformation seen_;                 ///< at the last key scan that saw something, in the submap's axes
  double path_ = 0;                      ///< m
  double sight_sum_ = 0;                 ///< of the mean ranges of key scans (m)
  std::size_t key_scans_ = 0;
};

}  // namespace submap_slam
