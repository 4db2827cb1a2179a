#include <submap_slam/viewer/viewer_source.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/landmark_errors.h>
#include <submap_slam/output/run_tables.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <utility>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

std::string inFolder(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

/** Frames and constraints of a run; while it goes on there may be fewer frames than submaps. */
void readJoined(ViewerModel& model, const std::string& folder) {
  JoinedMap joined;
  joined.frames = readFrames(inFolder(folder, kFramesFile));
  joined.constraints = readConstraints(inFolder(folder, kConstraintsFile));
  if (joined.frames.size() > model.submaps().size())
    throw InputError(fmt::format("{}: holds {} frames, expected those of {} submaps",
                                 inFolder(folder, kFramesFile), joined.frames.size(),
                                 model.submaps().size()));
  model.setJoined(std::move(joined));
}

std::string openLandmarks(ViewerModel& model, const std::string& file) {
  RecoveredLandmarkSubmaps read = recoverLandmarkSubmaps(file);
  model.setLandmarks(std::move(read.submaps));
  return read.damage;
}

/** Takes over the result if the run has finished and it is that of these submaps; its table of frames has the
 * poses where they end.
 * @return else why they are shown as a chain */
std::string readJoinedLandmarks(ViewerModel& model, const std::string& folder) {
  const std::size_t submaps = model.landmarkSubmaps().size();
  const std::string file = inFolder(folder, kFramesFile);
  if (!fs::exists(inFolder(folder, kMetricsFile)) || !fs::exists(file))
    return fmt::format("{}: holds no finished result; its submaps are shown as a chain", folder);
  JoinedLandmarks joined;
  joined.frames = readFrames(file);
  if (joined.frames.size() != submaps)
    return fmt::format("{}: holds {} frames, expected those of {} submaps, which are shown as a chain", file,
                       joined.frames.size(), submaps);
  joined.frames.insert(joined.frames.begin(), mrpt::poses::CPosePDFGaussian());
  joined.landmarks = readMappedLandmarks(inFolder(folder, "landmarks.csv"));
  model.setJoinedLandmarks(std::move(joined));
  return {};
}

std::string openLandmarkRun(ViewerModel& model, const std::string& folder) {
  const std::string damage = openLandmarks(model, inFolder(folder, kLandmarkFile));
  const std::string unjoined = readJoinedLandmarks(model, folder);
  return damage.empty() ? unjoined : damage;
}

std::string openRun(ViewerModel& model, const std::string& folder) {
  const std::string submaps = inFolder(folder, kSubmapFile), landmarks = inFolder(folder, kLandmarkFile);
  if (!fs::exists(submaps) && fs::exists(landmarks)) return openLandmarkRun(model, folder);
  if (!fs::exists(submaps))
    throw InputError(fmt::format("{}: holds no {}; expected the folder of a run", folder, kSubmapFile));
  RecoveredSubmaps read = recoverSubmaps(submaps);
  model.addSubmaps(read.submaps);
  if (fs::exists(inFolder(folder, kFramesFile))) readJoined(model, folder);
  return read.damage;
}

std::string openLog(ViewerModel& model, const std::string& file) {
  RawlogReader reader(file);
  std::vector<Frame> frames;
  std::string damage;
  try {
    while (auto frame = reader.next()) frames.push_back(std::move(*frame));
  } catch (const InputError& error) {
    if (frames.empty()) throw;
    damage = error.what();
  }
  model.setLog(std::move(frames));
  return damage;
}

}  // namespace

std::string openInto(ViewerModel& model, const std::string& file_or_folder) {
  if (!fs::exists(file_or_folder)) throw InputError(fmt::format("{}: no such file", file_or_folder));
  if (fs::is_directory(file_or_folder)) return openRun(model, file_or_folder);
  if (holdsLandmarkSubmaps(file_or_folder)) return openLandmarks(model, file_or_folder);
  RecoveredSubmaps read = recoverSubmaps(file_or_folder);
  if (read.submaps.empty()) return openLog(model, file_or_folder);
  model.addSubmaps(read.submaps);
  return read.damage;
}

RunFollower::RunFollower(std::string folder)
    : folder_(std::move(folder)), submaps_(inFolder(folder_, kSubmapFile)) {}

bool RunFollower::update(ViewerModel& model) {
  bool changed = false;
  if (fs::exists(inFolder(folder_, kSubmapFile))) {
    const GridSubmaps more = submaps_.readNew();
    model.addSubmaps(more);
    changed = !more.empty();
  }
  const std::string frames = inFolder(folder_, kFramesFile);
  if (!fs::exists(frames) || fs::last_write_time(frames) == frames_time_) return changed;
  const auto time = fs::last_write_time(frames);
  if (readFrames(frames).size() > model.submaps().size()) return changed;  // the submaps come the next time
  frames_time_ = time;
  readJoined(model, folder_);
  return true;
}

}  // namespace submap_slam
