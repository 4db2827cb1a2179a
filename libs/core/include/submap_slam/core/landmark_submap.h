#pragma once

#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/opengl/Visualizable.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace submap_slam {

/** A landmark as one submap sees it. */
struct SubmapFeature {
  uint32_t id = 0;      ///< equal ids are the same landmark, where the association is known
  double x = 0, y = 0;  ///< in the local map frame (m)
  uint32_t hits = 1;    ///< observations of it that the submap rests on
};

/** Where the robot was at one frame of a landmark submap. */
struct LandmarkNode {
  mrpt::Clock::time_point stamp;
  mrpt::math::TPose2D pose;  ///< T_s_robot (m, rad)
};

/** A landmark submap: estimate of the pose where it ends and of the landmarks seen on the way, in the frame
 * of the pose where it starts. The next submap starts where this one ends, so a sequence of submaps hangs
 * together (Huang, Wang, Dissanayake, "Sparse local submap joining filter", 2008). No measurement is used in
 * two of them.
 *
 * Being an MRPT observation, a file of submaps is a rawlog which rawlog-edit and RawLogViewer can open when
 * this library is loaded as a plugin.
 */
class LandmarkSubmap : public mrpt::obs::CObservation, public mrpt::opengl::Visualizable {
  DEFINE_SERIALIZABLE(LandmarkSubmap, submap_slam)

 public:
  /** MRPT would stamp it with the present time. */
  LandmarkSubmap() { timestamp = INVALID_TIMESTAMP; }

  uint32_t id = 0;  ///< position in the sequence, from 0

  /** When the robot was at `end_pose`; INVALID_TIMESTAMP if that is not known. */
  mrpt::Clock::time_point end_stamp = INVALID_TIMESTAMP;

  mrpt::math::TPose2D end_pose;  ///< T_s_end (m, rad)
  std::vector<SubmapFeature> features;
  bool ids_known = true;  ///< false: ids say nothing beyond this submap

  /** The path, as the local filter knows it, if that is known: the frames of the submap, without the one at
   * `end_pose` that begins the next. */
  std::vector<LandmarkNode> nodes;

  /** Covariance Q of the state (x_e, y_e, φ_e, x_1, y_1, …, x_n, y_n) (m, rad), symmetric. */
  mrpt::math::CMatrixDouble covariance;

  /** Number of elements of the state. */
  std::size_t dimension() const { return 3 + 2 * features.size(); }

  /** Largest distance of a feature from the start pose (m). */
  double radius() const;

  // mrpt::obs::CObservation
  void getSensorPose(mrpt::poses::CPose3D& pose) const override;
  void setSensorPose(const mrpt::poses::CPose3D& pose) override;
  void getDescriptionAsText(std::ostream& out) const override;
  bool exportTxtSupported() const override { return true; }
  std::string exportTxtHeader() const override;
  std::string exportTxtDataRow() const override;

  // mrpt::opengl::Visualizable: features and end pose with 3-sigma ellipses in the local map frame
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& out) const override;
};

/** Most features of a submap. More in a file is taken for damage: the covariance, with the square of their
 * number, would take up the memory. */
constexpr uint32_t kMostFeatures = 2000;

using LandmarkSubmaps = std::vector<LandmarkSubmap::Ptr>;

/** Least variance of an end pose that joining works with (m², rad²). A submap of a robot that stands still
 * may give zero, which would make the joint problem singular. */
constexpr double kLeastPoseVariance = 1e-8;

/** The covariance of a submap where end pose variances below kLeastPoseVariance are raised to it. */
mrpt::math::CMatrixDouble flooredCovariance(const LandmarkSubmap& submap);

/** Throws InputError saying what is wrong unless it has at most kMostFeatures, numbers are finite, ids differ
 * within the submap, and the covariance has the right size, is symmetric, and positive definite after
 * flooring. */
void requireUsable(const LandmarkSubmap& submap);

}  // namespace submap_slam
