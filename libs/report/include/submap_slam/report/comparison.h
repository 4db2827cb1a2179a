/** Runs side by side. The first one is the reference that the others are seen from. */
#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/eval/trajectory_error.h>
#include <submap_slam/report/run_folder.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace submap_slam {

/** A figure of each run: a number, a text, or null where a run has none. */
struct ComparisonRow {
  std::string name;
  std::vector<nlohmann::ordered_json> values;
};

struct ComparisonTable {
  std::string title;
  std::vector<ComparisonRow> rows;
};

/** A run seen from the reference. */
struct SeenFromReference {
  /** Pose of the run's map frame in that of the reference: such that the first pose of which the reference
   * knows the time is the same in both. The identity if there is no such pose. */
  mrpt::math::TPose2D T_ref_w;

  /** Poses at the same times, both in the frame of the reference; none for the reference itself. */
  std::vector<PosePair> pairs;
};

struct Comparison {
  std::vector<std::string> names;       ///< of the runs
  std::vector<SeenFromReference> seen;  ///< one for each run
  std::vector<ComparisonTable> tables;
};

/** Puts runs side by side: figures, time and memory, what differs between trajectories and between settings.
 * @param runs  at least one
 * @param names one for each */
Comparison compareRuns(const std::vector<RunFolder>& runs, const std::vector<std::string>& names);

/** The tables in Markdown, aligned so that they can be read as they are. */
std::string markdown(const Comparison& comparison);

/** The tables as one: `table,name` and a column for each run. */
std::string csv(const Comparison& comparison);

/** Data of compare.html, see webPage. */
nlohmann::ordered_json comparisonPage(const std::vector<RunFolder>& runs, const Comparison& comparison);

}  // namespace submap_slam
