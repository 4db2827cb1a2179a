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

  /** Joins and writes everything but the record of the run. */
  FinishedMap finish(const LandmarkSubmaps& submaps, RunSummary& summary);

  /** After finish(): T_s_end of each submap, as all joined landmarks have it; none if joining failed. */
  const std::vector<mrpt::poses::CPose2D>& ends() const { return ends_; }

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
  std::vector<mrpt::poses::CPose2D> ends_;
};

/** Says how far the path of the landmarks is from that of the grids, as `landmark_path_difference_…` too, and
 * warns where it is much of the way. */
void comparePaths(const Trajectory& grid_path, const Trajectory& landmark_path, Metrics& metrics,
                  Reporter& reporter);

}  // namespace submap_slam
