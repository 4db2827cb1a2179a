#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/relations.h>
#include <submap_slam/eval/trajectory_error.h>
#include <submap_slam/pipeline/run_files.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "landmark_scores.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

struct EvalOptions {
  std::string result;      ///< trajectory or folder
  std::string trajectory;  ///< of the result
  std::string relations, reference, landmarks;
  RelationsOptions filter;
  double split_s = 60;
  bool json = false;
};

/** Null if there is nothing to make statistics of: a mean of 0 would look like a perfect result. */
Json toJson(const ErrorStatistics& e) {
  if (e.count == 0) return nullptr;
  return {{"mean", e.mean},
          {"std", e.std},
          {"rmse", e.rmse},
          {"median", e.median},
          {"percentile_95", e.percentile_95},
          {"max", e.max}};
}

Json toJson(const RelationsResult& r) {
  return {{"total", r.total},
          {"used", r.used},
          {"skipped", r.skipped},
          {"filtered", r.filtered},
          {"translation_m", toJson(r.translation_m)},
          {"rotation_deg", toJson(r.rotation_deg)}};
}

Json toJson(const TrajectoryError& e) {
  return {{"count", e.translation_m.count},
          {"translation_m", toJson(e.translation_m)},
          {"rotation_deg", toJson(e.rotation_deg)}};
}

void checkLimits(const EvalOptions& options) {
  const auto check = [](const char* option, double seconds) {
    if (!(seconds >= 0)) throw ConfigError(fmt::format("{} {}: must not be negative", option, seconds));
  };
  check("--min-dt", options.filter.min_dt_s);
  check("--max-dt", options.filter.max_dt_s);
  check("--split", options.split_s);
}

/** The relations within the limits that the user gave. */
std::vector<Relation> filtered(const std::vector<Relation>& relations, const RelationsOptions& limits) {
  std::vector<Relation> kept;
  for (const auto& relation : relations) {
    const double dt = std::abs(relation.t2 - relation.t1);
    if (dt >= limits.min_dt_s && dt <= limits.max_dt_s) kept.push_back(relation);
  }
  return kept;
}

Json evaluateAgainstRelations(const EvalOptions& options, const TimedTrajectory& trajectory) {
  const auto relations = filtered(readRelations(options.relations), options.filter);
  if (relations.empty())
    throw InputError(
        fmt::format("{}: no relation is as long as --min-dt and --max-dt ask for", options.relations));
  const RelationsReport report = evaluateRelationsSplit(relations, trajectory, options.split_s);
  if (report.all.used == 0)
    throw InputError(fmt::format("{}: no relation that {} covers; are they of the same log?",
                                 options.relations, options.trajectory));
  if (!options.json) fmt::print("{}", formatTable(report));
  return {{"all", toJson(report.all)}, {"local", toJson(report.local)}, {"global", toJson(report.global)}};
}

Json evaluateAgainstReference(const EvalOptions& options, const TimedTrajectory& trajectory) {
  const auto pairs = associate(readTum(options.reference), trajectory);
  if (pairs.empty())
    throw InputError(fmt::format("{}: no pose at a time that {} covers; are they of the same log?",
                                 options.reference, options.trajectory));
  const TrajectoryError absolute = absoluteTrajectoryError(pairs), relative = relativePoseError(pairs);
  if (!options.json) fmt::print("{}", formatTable(absolute, relative));
  return {{"absolute", toJson(absolute)}, {"relative", toJson(relative)}};
}

bool isFolder(const EvalOptions& options) { return fs::is_directory(options.result); }

bool hasLandmarks(const EvalOptions& options) {
  return isFolder(options) && formsOf(options.result).landmarks;
}

Json evaluateLandmarks(const EvalOptions& options) {
  const fs::path submaps = fs::path(options.result) / kLandmarkFile;
  const LandmarkScores scores = landmarkScores(options.result, fs::exists(submaps) ? submaps.string() : "",
                                               readTum(options.reference), options.landmarks);
  if (!options.json) fmt::print("{}", landmarkTable(scores));
  Json figures;
  addLandmarkScores(figures, scores);
  return figures;
}

void checkTruth(const EvalOptions& options) {
  if (options.relations.empty() && options.reference.empty())
    throw ConfigError("eval: give --relations R.relations or --reference T.tum");
  if (options.landmarks.empty()) return;
  if (options.reference.empty())
    throw ConfigError("eval: --landmarks needs --reference T.tum, which tells where the map begins");
  if (!hasLandmarks(options))
    throw InputError(
        fmt::format("{}: --landmarks: expected the folder of a result with landmarks", options.result));
}

int runEval(EvalOptions& options) {
  checkTruth(options);
  checkLimits(options);
  options.trajectory =
      isFolder(options) ? (fs::path(options.result) / "trajectory.tum").string() : options.result;
  const TimedTrajectory trajectory = readTum(options.trajectory);
  Json result;
  if (!options.relations.empty()) result["relations"] = evaluateAgainstRelations(options, trajectory);
  if (!options.reference.empty()) result["reference"] = evaluateAgainstReference(options, trajectory);
  if (!options.reference.empty() && hasLandmarks(options)) result["landmarks"] = evaluateLandmarks(options);
  if (options.json) fmt::print("{}\n", result.dump(2));
  return kSuccess;
}

}  // namespace

void addEvalCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<EvalOptions>();
  CLI::App* command = app.add_subcommand("eval", "Errors of a result against relations or a reference");
  command
      ->add_option("result", options->result,
                   "The trajectory to judge, or the folder of a result: its trajectory, and with --reference "
                   "also its landmarks and whether their covariances are honest")
      ->required()
      ->type_name("TRAJECTORY.tum|FOLDER");
  command->add_option("--relations", options->relations, "Known relative poses: t1 t2 x y z roll pitch yaw")
      ->type_name("R.relations")
      ->group("Truth");
  command->add_option("--reference", options->reference, "Reference trajectory in TUM format")
      ->type_name("T.tum")
      ->group("Truth");
  command->add_option("--landmarks", options->landmarks, "True landmarks: id,x,y in the reference's frame")
      ->type_name("L.csv")
      ->group("Truth");
  command->add_option("--min-dt", options->filter.min_dt_s, "Only relations at least this long (s)")
      ->type_name("S")
      ->group("Relations");
  command->add_option("--max-dt", options->filter.max_dt_s, "Only relations at most this long (s)")
      ->type_name("S")
      ->group("Relations");
  command->add_option("--split", options->split_s, "Limit between local and global relations (s)")
      ->type_name("S")
      ->capture_default_str()
      ->group("Relations");
  command->add_flag("--json", options->json, "Print JSON instead of tables");
  command->footer("Example: submap-slam eval out/trajectory.tum --relations intel.relations");
  command->callback([options, &exit_code] { exit_code = runEval(*options); });
}

}  // namespace submap_slam
