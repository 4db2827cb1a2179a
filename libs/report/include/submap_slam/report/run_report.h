/** What report.html shows of a run, as JSON; web/ says how it is shown. */
#pragma once

#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/eval/mapping_progress.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace submap_slam {

/** What is known of a run beside its map. */
// NOLINTNEXTLINE(bugprone-exception-escape): takes asserts of the JSON library for throws
struct RunRecord {
  std::string input;                  ///< name of the log or of the file of submaps, without its folder
  std::string ini;                    ///< every effective parameter
  std::vector<std::string> messages;  ///< log.txt
  nlohmann::ordered_json metrics;     ///< metrics.json
};

/** A run with grid submaps: map picture, trajectory with the standard deviation of each position, submaps
 * with their outlines and 3-sigma ellipses, constraints with what is left of them after joining, iterations.
 * Throws std::invalid_argument if frames and progress are not as many as the submaps, and as
 * GridSubmap::packedEvidence(). */
nlohmann::ordered_json runReport(const GridSubmaps& submaps, const JoinedMap& joined,
                                 const std::vector<SubmapProgress>& progress, const RunRecord& record);

/** The same with landmark submaps: landmarks and frames with their ellipses instead of a map picture. */
nlohmann::ordered_json runReport(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined,
                                 const RunRecord& record);

}  // namespace submap_slam
