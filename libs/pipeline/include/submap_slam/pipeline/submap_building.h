/** From a log to files of submaps. */
#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/landmarks/landmark_mapper.h>
#include <submap_slam/rawlog/submap_log.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/map_forms.h>
#include <submap_slam/pipeline/reporter.h>
#include <submap_slam/pipeline/stretch_source.h>

namespace submap_slam {

/** The submaps of one stretch, in the forms that are asked for. */
struct StretchSubmaps {
  GridSubmaps grids;
  LandmarkSubmaps landmarks;
};

/** Builds all forms of the submaps of a stretch. With both, landmarks correct the odometry that the grids'
 * filter gets, and landmark submaps are made of the same frames as the grids. Thread-safe. */
class StretchMapper {
 public:
  /** Throws ConfigError if parameters contradict each other. */
  StretchMapper(const Configuration& config, const MapForms& forms);

  StretchSubmaps map(const Stretch& stretch) const;

 private:
  std::unique_ptr<LocalMapper> grids_;  // null: none
  std::optional<LandmarkMapper> landmarks_;
};

/** The files of submaps of a run, one for each form. A kill may leave one of them a stretch ahead. */
class SubmapFiles {
 public:
  std::optional<SubmapLogWriter> grids, landmarks;

  /** Stretches that all files have. */
  uint64_t stretchesDone() const;

  /** Submaps of a form that the run has; of grids, if it has both. */
  uint64_t submapsDone() const { return (grids ? grids : landmarks)->state().submaps_done; }

  /** Gives the submaps their ids and appends those of a stretch to the files that do not have it yet. */
  void append(uint64_t stretch, const StretchSubmaps& submaps);

  void finish();
};

/** Called in log order, when the submaps of a stretch are on disk, with the share of the log that was read up
 * to its end. */
using StretchDone = std::function<void(double)>;

/** Builds the submaps of all stretches that the files do not have yet, in parallel; each is on disk before
 * the progress goes on. Memory does not grow with the log. After a stop signal no stretch is begun any more;
 * returns false if it left stretches out.
 * @param on_disk may be empty; the files do not change while it runs, but stretches are built meanwhile */
bool buildSubmaps(StretchSource& source, const StretchMapper& mapper, SubmapFiles& files, Reporter& reporter,
                  const StretchDone& on_disk = {});

}  // namespace submap_slam
