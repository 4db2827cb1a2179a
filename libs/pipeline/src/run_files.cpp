#include <submap_slam/pipeline/run_files.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/version.h>

#include <filesystem>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

/** What tells this run from another one. */
ResumeState runIdentity(const std::string& log, const Configuration& config) {
  ResumeState run;
  run.version = version();
  run.config_hash = config.submapFingerprint();
  run.log = fs::path(log).filename().string();
  run.log_bytes = fs::file_size(log);
  run.log_hash = endsHash(log);
  return run;
}

/** A run that was killed at its very start leaves a file of no bytes. */
bool isEmptyFile(const fs::path& file) { return fs::is_regular_file(file) && fs::file_size(file) == 0; }

}  // namespace

void refuseFinished(const std::string& submap_file) {
  if (!fs::exists(submap_file)) return;
  const auto state = readResumeState(submap_file);
  if (state && state->complete)
    throw ConfigError(fmt::format("{}: is finished; use --overwrite to build it anew", submap_file));
}

SubmapLogWriter openSubmapFile(const std::string& file, const std::string& log, const Configuration& config,
                               bool overwrite, Reporter& reporter) {
  if (fs::exists(file) && fs::equivalent(file, log))
    throw ConfigError(fmt::format("{}: is the log itself; submaps need a file of their own", file));
  const ResumeState run = runIdentity(log, config);
  if (overwrite || !fs::exists(file) || isEmptyFile(file)) return SubmapLogWriter(file, run);
  if (!readResumeState(file))
    throw ConfigError(
        fmt::format("{}: exists and is not of an unfinished run; use --overwrite to replace it", file));
  auto writer = SubmapLogWriter::resume(file, run);
  reporter.note(fmt::format("continuing after {} submaps", writer.state().submaps_done));
  return writer;
}

namespace {

SubmapFiles openFiles(const std::string& grid_file, const std::string& landmark_file, const MapForms& forms,
                      const std::string& log, const Configuration& config, bool overwrite,
                      Reporter& reporter) {
  SubmapFiles files;
  if (forms.grids) files.grids = openSubmapFile(grid_file, log, config, overwrite, reporter);
  if (forms.landmarks) files.landmarks = openSubmapFile(landmark_file, log, config, overwrite, reporter);
  return files;
}

bool isBegun(const fs::path& submaps) {
  return fs::exists(resumeFileOf(submaps.string())) || isEmptyFile(submaps);
}

}  // namespace

SubmapFiles openSubmapFiles(const OutputDirectory& out, const MapForms& forms, const std::string& log,
                            const Configuration& config, bool overwrite, Reporter& reporter) {
  return openFiles(out.file(kSubmapFile), out.file(kLandmarkFile), forms, log, config, overwrite, reporter);
}

SubmapFiles openSubmapFiles(const std::string& file, const MapForms& forms, const std::string& log,
                            const Configuration& config, bool overwrite, Reporter& reporter) {
  return openFiles(file, forms.grids ? landmarkFileBeside(file) : file, forms, log, config, overwrite,
                   reporter);
}

std::string landmarkFileBeside(const std::string& file) {
  const fs::path path(file);
  return (path.parent_path() / (path.stem().string() + "_landmarks" + path.extension().string())).string();
}

OutputDirectory openFolder(const std::string& folder, bool overwrite) {
  const fs::path path(folder);
  const bool begun = isBegun(path / kSubmapFile) || isBegun(path / kLandmarkFile);
  const bool unfinished = begun && !fs::exists(path / kMetricsFile);
  OutputDirectory out(path, overwrite || unfinished);
  if (overwrite) fs::remove(path / kMetricsFile);  // from here on the folder holds an unfinished run
  return out;
}

void requireSubmaps(const std::string& file) {
  if (!SubmapLogReader(file).next()) throw InputError(fmt::format("{}: holds no submaps", file));
}

RecoveredSubmaps readUsableSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store) {
  RecoveredSubmaps read = recoverSubmaps(file, store);
  if (read.submaps.empty())
    throw InputError(read.damage.empty() ? fmt::format("{}: holds no submaps", file) : read.damage);
  return read;
}

}  // namespace submap_slam
