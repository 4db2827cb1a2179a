/** The way from landmark submaps to a map of landmarks. */
#pragma once

#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/output/output_directory.h>

#include <submap_slam/pipeline/finish_run.h>
#include <submap_slam/pipeline/pipeline.h>
#include <submap_slam/pipeline/update_schedule.h>

#include <memory>
#include <string>

namespace submap_slam {

/** Joins a file of landmark submaps (see readLandmarkSubmaps) and writes all results to a folder.
 * @param overwrite replace results in a folder that holds something */
RunSummary joinLandmarkFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                            const Configuration& config, Reporter& reporter);

/** The landmarks of a run: joined on the way, if the user wants that, and in the end. Submaps whose ids say
 * nothing beyond them are associated by position. */
class LandmarkHalf {
 public:
  /** @param beside_grids the run has grids too: files and figures of the landmarks get the prefix `landmark_`
   */
  LandmarkHalf(const LandmarkJoiner& joiner, const OutputDirectory& out, bool beside_grids,
               double update_growth, Reporter& reporter);

  /** To be called when the file of the run holds so many submaps: joins them where an update is due, and
   * replaces map.png, trajectory.tum and landmarks.csv; updates.csv gets a line. */
  void update(std::size_t submaps_in_file, double fraction);

  /** Joins and writes everything but the record of the run.
   * @param grid_path where there are grids: `landmark_path_difference_…` says how the landmarks' path differs
   */
  FinishedMap finish(const LandmarkSubmaps& submaps, const Trajectory& grid_path, RunSummary& summary);

  /** How many submaps the latest map has; 0: there is none. */
  std::size_t submapsInMap() const { return in_map_; }

 private:
  JoinedLandmarks join(const LandmarkSubmaps& submaps, bool& stopped);

  const LandmarkJoiner& joiner_;
  std::unique_ptr<IncrementalLandmarkJoin> at_work_;
  const OutputDirectory& out_;
  std::string prefix_;
  UpdateSchedule schedule_;
  Reporter& reporter_;
  std::string table_;  // content of updates.csv
  std::size_t in_map_ = 0;
};

}  // namespace submap_slam
