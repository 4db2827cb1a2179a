#pragma once

#include <mrpt/math/CMatrixFixed.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/landmark_submap.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** A landmark of the joined map. */
struct JoinedLandmark {
  uint32_t id = 0;                         ///< that of the submaps where the association is known
  double x = 0, y = 0;                     ///< in the global map frame (m)
  mrpt::math::CMatrixDouble22 covariance;  ///< (m²)
  uint32_t hits = 0;                       ///< sum over the submaps that saw it
};

/** What became of one feature of one submap. */
struct FeatureAssociation {
  enum class Kind {
    kKnown,    ///< by the id in the submap
    kMatched,  ///< with a landmark that was there before
    kNew,      ///< made a landmark
    kDropped   ///< ambiguous, left out
  };
  uint32_t submap = 0;   ///< id of the submap
  uint32_t feature = 0;  ///< id of the feature in the submap
  Kind kind = Kind::kKnown;
  uint32_t landmark = 0;  ///< id of the joined landmark; without meaning if dropped
  double distance2 = 0;   ///< squared Mahalanobis distance to it, or if new or dropped to the nearest
  /// one, infinite if there is none
};
const char* toString(FeatureAssociation::Kind kind);

/** Landmarks and submap frames in the global map frame, and what came with finding them. */
struct JoinedLandmarks {
  JoinStatus status = JoinStatus::kChained;
  std::string reason;

  /** T_w_s of each submap in their order, then the end pose of the last one. The first is the identity. */
  std::vector<mrpt::poses::CPosePDFGaussian> frames;

  std::vector<JoinedLandmark> landmarks;  ///< by id

  /** Sum over the submaps of rᵀ Q⁻¹ r, r = submap − its prediction from frames and landmarks. */
  double objective = 0;

  std::vector<JoinIteration> iterations;         ///< over all submaps together
  bool association_known = true;                 ///< false: the ids of the submaps were ignored
  std::vector<FeatureAssociation> associations;  ///< of every feature of every submap, in their order
};

/** The path in the global map frame. Of submaps with nodes, the pose of each of them: what joining changed of
 * the submap's end pose is spread over its nodes by the path length to them. Where a submap has none, the end
 * pose of each submap with its stamp; where these are missing too, positions in the sequence stand for
 * seconds. */
Trajectory trajectoryOf(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined);

/** How an association that ignored the ids compares with them. Each joined landmark stands for the id that
 * most of its features have. */
struct AssociationErrors {
  std::size_t wrong = 0;    ///< features whose landmark stands for another id
  std::size_t missed = 0;   ///< landmarks beyond the first that stand for the same id
  std::size_t dropped = 0;  ///< features left out
};
AssociationErrors compareWithIds(const std::vector<FeatureAssociation>& associations);

}  // namespace submap_slam
