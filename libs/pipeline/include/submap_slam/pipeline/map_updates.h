#pragma once

#include <submap_slam/output/output_directory.h>
#include <submap_slam/pipeline/edited_submaps.h>
#include <submap_slam/pipeline/joining.h>
#include <submap_slam/pipeline/reporter.h>
#include <submap_slam/rawlog/submap_log.h>

#include <cstddef>
#include <optional>
#include <string>

#include <submap_slam/pipeline/update_schedule.h>

namespace submap_slam {

constexpr const char* kUpdatesFile = "updates.csv";

/** Joins what is built so far while the rest is being built, and writes the map of the moment in the place of
 * the results (writeMapSoFar); updates.csv gets a line each time.
 *
 * The map after an update is the one that joining these submaps alone would give. It is due when there are
 * `growth` times the submaps of the last one, rounded: for n submaps and joiners whose time goes with n, all
 * updates together take at most growth / (growth − 1) times as long as one with all submaps.
 */
class MapUpdates {
 public:
  /** @param follower of the file of submaps
   * @param submaps  get what the follower reads
   * @param growth   at least 1, which means an update after each stretch of the log
   * @param goes_on  an earlier run began the file; its updates stay listed */
  MapUpdates(SubmapFollower& follower, EditedSubmaps& submaps, Joining& joining, const OutputDirectory& out,
             double growth, bool goes_on, Reporter& reporter);

  /** To be called when the file holds so many submaps. Where joiners fail the run only says so. Throws as
   * readers and writers do.
   * @param fraction share of the log that they are of */
  void update(std::size_t submaps_in_file, double fraction);

  /** How many submaps the latest map has; 0: there is none. */
  std::size_t submapsInMap() const { return in_map_; }

 private:
  std::optional<JoinOutcome> join();
  void list(const JoinOutcome& outcome, double read_s, double write_s);

  SubmapFollower& follower_;
  EditedSubmaps& submaps_;
  Joining& joining_;
  const OutputDirectory& out_;
  UpdateSchedule schedule_;
  Reporter& reporter_;
  std::string table_;       // content of updates.csv
  std::size_t in_map_ = 0;  // submaps of the last update that gave a map
};

}  // namespace submap_slam
