#pragma once

#include <submap_slam/rawlog/submap_log.h>
#include <submap_slam/viewer/viewer_model.h>

#include <filesystem>
#include <memory>
#include <string>

namespace submap_slam {

/** Shows a rawlog, a file of submaps, or the folder of a run with its submaps, frames and constraints; of a
 * run that has landmarks alone, its submaps and, where it has finished, their frames and the joined
 * landmarks. Throws InputError if it is none of these; a damaged file is shown up to the damage.
 * @return what is wrong with the file, or why its submaps are shown as a chain; empty: nothing */
std::string openInto(ViewerModel& model, const std::string& file_or_folder);

/** Follows the folder of a run while it grows. */
class RunFollower {
 public:
  explicit RunFollower(std::string folder);

  /** Takes over what is new; false if nothing is. Throws InputError for damaged files. */
  bool update(ViewerModel& model);

 private:
  std::string folder_;
  SubmapFollower submaps_;
  std::filesystem::file_time_type frames_time_{};
};

}  // namespace submap_slam
