#include <submap_slam/pipeline/submap_building.h>

#include <submap_slam/core/errors.h>
#include <submap_slam/mapping/grid_mapper.h>
#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace submap_slam {
namespace {

/** A stretch on its way through the stages. */
struct Job {
  Stretch stretch;
  StretchSubmaps submaps;
  double fraction_read = 0;
  bool built = false;
};
using JobPtr = std::shared_ptr<Job>;

template <class Submaps>
void number(const SubmapLogWriter& writer, const Submaps& submaps) {
  auto id = static_cast<uint32_t>(writer.state().submaps_done);
  for (const auto& submap : submaps) submap->id = id++;
}

/** Odometry of the log for the nodes of the submaps of a stretch. */
void setOdometry(const GridSubmaps& submaps, const Stretch& stretch) {
  auto frame = stretch.frames.begin() + static_cast<std::ptrdiff_t>(stretch.warm_up);
  for (const auto& submap : submaps)
    for (SubmapNode& node : submap->nodes) node.odometry = (frame++)->odometry;
}

}  // namespace

StretchMapper::StretchMapper(const Configuration& config, const MapForms& forms) {
  if (forms.grids && forms.landmarks && config.landmark_mapper.single_map)
    throw ConfigError("[landmark_mapper] single_map: grids beside landmarks need submaps");
  if (forms.grids) grids_ = makeGridMapper(config.mapper, config.seed);
  if (forms.landmarks) landmarks_.emplace(config.landmark_mapper, config.seed);
}

StretchSubmaps StretchMapper::map(const Stretch& stretch) const {
  if (!grids_) return {{}, landmarks_->map(stretch)};
  if (!landmarks_) return {grids_->map(stretch), {}};
  StretchSubmaps both{grids_->map(landmarks_->withCorrectedOdometry(stretch)), {}};
  setOdometry(both.grids, stretch);
  both.landmarks = landmarks_->mapBeside(both.grids, stretch);
  return both;
}

uint64_t SubmapFiles::stretchesDone() const {
  uint64_t done = std::numeric_limits<uint64_t>::max();
  for (const auto* file : {&grids, &landmarks})
    if (*file) done = std::min(done, (*file)->state().stretches_done);
  return done;
}

void SubmapFiles::append(uint64_t stretch, const StretchSubmaps& submaps) {
  if (grids && grids->state().stretches_done <= stretch) {
    number(*grids, submaps.grids);
    grids->appendStretch(submaps.grids);
  }
  if (landmarks && landmarks->state().stretches_done <= stretch) {
    number(*landmarks, submaps.landmarks);
    landmarks->appendLandmarkStretch(submaps.landmarks);
  }
}

void SubmapFiles::finish() {
  if (grids) grids->finish();
  if (landmarks) landmarks->finish();
}

bool buildSubmaps(StretchSource& source, const StretchMapper& mapper, SubmapFiles& files, Reporter& reporter,
                  const StretchDone& on_disk) {
  using tbb::filter_mode;
  const uint64_t built_before = files.stretchesDone();
  bool read_all = false, left_out = false;
  std::size_t frames_built = 0;

  const auto read = [&](tbb::flow_control& flow) -> JobPtr {
    while (!reporter.stopRequested()) {
      auto stretch = source.next();
      read_all = !stretch;
      if (read_all) break;
      if (stretch->index < built_before) continue;  // an earlier run did it
      return std::make_shared<Job>(Job{std::move(*stretch), {}, source.fractionRead(), false});
    }
    flow.stop();
    return nullptr;
  };
  const auto build = [&](const JobPtr& job) {
    if (reporter.stopRequested()) return job;
    job->submaps = mapper.map(job->stretch);
    job->built = true;
    return job;
  };
  const auto write = [&](const JobPtr& job) {
    left_out = left_out || !job->built;
    if (left_out) return;  // also what comes behind it, so that the file has no gap
    files.append(job->stretch.index, job->submaps);
    frames_built += job->stretch.ownFrames();
    reporter.progress("building submaps", job->fraction_read, frames_built, "scans");
    if (on_disk) on_disk(job->fraction_read);
  };

  reporter.progress("building submaps", 0);
  const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::size_t in_flight = threads + 2;  // one being read, one being written
  tbb::parallel_pipeline(in_flight, tbb::make_filter<void, JobPtr>(filter_mode::serial_in_order, read) &
                                        tbb::make_filter<JobPtr, JobPtr>(filter_mode::parallel, build) &
                                        tbb::make_filter<JobPtr, void>(filter_mode::serial_in_order, write));
  const bool complete = read_all && !left_out;
  if (complete) files.finish();
  return complete;
}

}  // namespace submap_slam
