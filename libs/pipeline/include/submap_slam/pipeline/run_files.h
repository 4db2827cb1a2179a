/** Where a run writes to, and whether it continues an earlier one. */
#pragma once

#include <submap_slam/output/output_directory.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/reporter.h>
#include <submap_slam/rawlog/submap_log.h>

#include <memory>
#include <string>

#include <submap_slam/pipeline/map_forms.h>
#include <submap_slam/pipeline/submap_building.h>

namespace submap_slam {

constexpr const char* kSubmapFile = "submaps.rawlog";
constexpr const char* kLandmarkFile = "landmark_submaps.rawlog";
constexpr const char* kSpillFile = "submaps.spill";  ///< see SubmapStore: never seen in the folder
constexpr const char* kReportFile = "report.html";
constexpr const char* kMetricsFile =
    "metrics.json";  ///< written last: a folder that has it holds a finished run

/** What is said behind the damage of a file of submaps. */
constexpr const char* kRestIsJoined = "; the submaps before it are joined";

/** Throws ConfigError if the file of submaps is there and finished. */
void refuseFinished(const std::string& submap_file);

/** Opens the file that submaps are written to: anew, or where an unfinished run with the same log and
 * parameters stopped. Throws ConfigError if there is a file that no such run made or if it is the log itself,
 * InputError if it was another run.
 * @param overwrite anew in any case */
SubmapLogWriter openSubmapFile(const std::string& file, const std::string& log, const Configuration& config,
                               bool overwrite, Reporter& reporter);

/** Opens kSubmapFile and kLandmarkFile in the folder as openSubmapFile does, those that the run writes. */
SubmapFiles openSubmapFiles(const OutputDirectory& out, const MapForms& forms, const std::string& log,
                            const Configuration& config, bool overwrite, Reporter& reporter);

/** The same for a file that the user named: that of the only form or of the grids. */
SubmapFiles openSubmapFiles(const std::string& file, const MapForms& forms, const std::string& log,
                            const Configuration& config, bool overwrite, Reporter& reporter);

/** `a/b_landmarks.rawlog` for `a/b.rawlog` */
std::string landmarkFileBeside(const std::string& file);

/** The folder of results; one that holds an unfinished run is taken to finish it. */
OutputDirectory openFolder(const std::string& folder, bool overwrite);

/** Throws InputError unless the file begins with a submap. */
void requireSubmaps(const std::string& file);

/** The submaps of a file, up to the first damage if there is one (see RecoveredSubmaps::damage). Throws
 * InputError if the file holds none. */
RecoveredSubmaps readUsableSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store);

}  // namespace submap_slam
