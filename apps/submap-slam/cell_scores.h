#pragma once

#include <submap_slam/core/frame.h>
#include <submap_slam/eval/timed_trajectory.h>
#include <submap_slam/mapping/evidence_renderer.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/metrics.h>

#include <string>
#include <vector>

namespace submap_slam {

/** All frames of a log. Throws InputError. */
std::vector<Frame> readFrames(const std::string& log, const ReaderParams& reader);

/** The map that scans make if each is taken where the trajectory says; frames without a pose are left out.
 * @param T_map_w where the trajectory's frame is in the map */
EvidenceGrid mapFromPoses(const std::vector<Frame>& frames, const TimedTrajectory& trajectory,
                          const mrpt::math::TPose2D& T_map_w, const GridMapperParams& params);

/** Adds mae_m, mae_rad, rmse_m, rmse_rad and final_m, that of the last position (first pose aligned); ate_m
 * and ate_deg (RMSE after least squares alignment), ape_mean_m, ape_rmse_m and ape_std_m of the same errors;
 * rpe_mean_m, rpe_rmse_m, rpe_std_m and rpe_rmse_deg, from one scan to the next. Throws InputError if the
 * trajectories have no time in common. */
void addPoseScores(Metrics& scores, const TimedTrajectory& estimate, const TimedTrajectory& truth);

/** Adds auc, precision, recall, accuracy and coverage of a map in the estimate's frame against the map from
 * the true poses, its first pose at the estimate's. */
void addMapScores(Metrics& scores, const EvidenceGrid& map, const TimedTrajectory& estimate,
                  const TimedTrajectory& truth, const std::vector<Frame>& frames,
                  const GridMapperParams& params);

/** Adds relations_m, relations_rmse_m, relations_std_m, relations_deg, local_relations_m and
 * local_relations_deg. */
void addRelationScores(Metrics& scores, const TimedTrajectory& estimate, const std::string& relations_file);

}  // namespace submap_slam
