#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/import/import.h>
#include <submap_slam/output/replace_file.h>

#include <cmath>
#include <filesystem>
#include <memory>

#include "commands.h"
#include "reporter.h"
#include "stop_signal.h"

namespace submap_slam {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = M_PI / 180;

struct ImportCommandOptions {
  std::string input, output, form, stamps = "auto";
  std::vector<double> sensor_pose, beams;  // as given: m and degrees
  double max_range = 0;
  ImportOptions import;
  bool overwrite = false, quiet = false;
};

CarmenStamps stampsOf(const std::string& name) {
  if (name == "ipc") return CarmenStamps::kIpc;
  if (name == "logger") return CarmenStamps::kLogger;
  return CarmenStamps::kAuto;
}

ImportOptions importOptions(const ImportCommandOptions& options) {
  ImportOptions result = options.import;
  if (!options.form.empty()) result.form = importForms().at(options.form);
  if (options.max_range > 0) result.max_range = options.max_range;
  if (!options.sensor_pose.empty())
    result.T_robot_sensor =
        mrpt::math::TPose2D(options.sensor_pose[0], options.sensor_pose[1], options.sensor_pose[2] * kDegree);
  if (!options.beams.empty())
    result.beam_angles = BeamAngles{options.beams[0] * kDegree, options.beams[1] * kDegree};
  result.stamps = stampsOf(options.stamps);
  return result;
}

int runImport(const ImportCommandOptions& options) {
  if (fs::exists(options.output)) {
    if (!options.overwrite)
      throw ConfigError(fmt::format("{}: exists; use --overwrite to replace it", options.output));
    if (fs::exists(options.input) && fs::equivalent(options.input, options.output))
      throw ConfigError(fmt::format("{}: is the input", options.output));
  }
  Reporter reporter(options.quiet);
  const auto progress = [&](double share, const std::string& what) {
    reporter.progress(what, share);
    return !stopRequested();
  };
  ImportReport report;
  replaceFile(options.output, [&](const std::string& file) {
    report = importFile(options.input, file, importOptions(options), progress);
  });
  for (const auto& warning : report.warnings) reporter.warning(warning);
  for (const auto& damage : report.damage) reporter.warning(damage);
  reporter.note(report.asText() + "written: " + options.output);
  return report.damaged() ? kDamagedLog : kSuccess;
}

void addFormOptions(CLI::App& command, ImportCommandOptions& options) {
  const char* group = "What the file does not say";
  command.add_option("--sensor-pose", options.sensor_pose, "Pose of the sensor on the robot, m and degrees")
      ->expected(3)
      ->delimiter(',')
      ->type_name("X,Y,YAW")
      ->group(group);
  command.add_option("--max-range", options.max_range, "Ranges from here on (m) are no return")
      ->check(CLI::PositiveNumber)
      ->type_name("R")
      ->group(group);
  command
      .add_option("--topics", options.import.topics,
                  "ROS bag: topics to read: /scan,/odom (default: all scans, first odometry)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("TOPICS")
      ->group(group);
  command
      .add_option("--beams", options.beams,
                  "Angle of the first beam and from one to the next, degrees, left positive")
      ->expected(2)
      ->delimiter(',')
      ->type_name("FIRST,STEP")
      ->group(group);
  command.add_option("--stamps", options.stamps, "CARMEN: which of the two stamps of a line counts")
      ->check(CLI::IsMember({"auto", "ipc", "logger"}))
      ->capture_default_str()
      ->type_name("auto|ipc|logger")
      ->group(group);
}

void addLandmarkOptions(CLI::App& command, ImportOptions& options) {
  const char* group = "Landmarks";
  command.add_option("--odometry", options.odometry_file, "Lines 'stamp x y theta', or a TUM file")
      ->type_name("FILE")
      ->group(group);
  command.add_option("--controls", options.controls_file, "Lines 'stamp speed turn', m/s and rad/s or rad")
      ->type_name("FILE")
      ->group(group);
  command
      .add_option("--wheel-base", options.wheel_base,
                  "Turn in --controls is a steering angle, the axles are this far apart (m)")
      ->check(CLI::PositiveNumber)
      ->type_name("L")
      ->group(group);
  command
      .add_option("--encoder-offset", options.encoder_offset,
                  "Speed in --controls is that of a wheel so far left of the rear axle's centre (m)")
      ->type_name("H")
      ->group(group);
}

std::string formList() {
  std::string list;
  for (const auto& [name, form] : importForms()) list += (list.empty() ? "" : "|") + name;
  return list;
}

}  // namespace

void addImportCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ImportCommandOptions>();
  CLI::App* command = app.add_subcommand("import", "Makes a rawlog from a log of another program");
  command
      ->add_option("input", options->input,
                   "Log, also gzip: CARMEN, ROS 1 bag, scans or landmarks as text, pose graph")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", options->output, "Rawlog to write; of a pose graph a .g2o file")
      ->required()
      ->type_name("OUT.rawlog");
  std::vector<std::string> names;
  for (const auto& [name, form] : importForms()) names.push_back(name);
  command->add_option("--format", options->form, "Form of the log (default: by its content)")
      ->check(CLI::IsMember(names))
      ->type_name(formList());
  addFormOptions(*command, *options);
  addLandmarkOptions(*command, options->import);
  command->add_flag("-q,--quiet", options->quiet, "No progress and no summary")->group("Run");
  command->add_flag("--overwrite", options->overwrite, "Replace a file that exists")->group("Run");
  command->footer(
      "Damaged lines are left out and named; the exit code is then 3. docs/import.md describes the forms.\n"
      "Example: submap-slam import intel.log.gz -o intel.rawlog && submap-slam check intel.rawlog");
  command->callback([options, &exit_code] { exit_code = runImport(*options); });
}

}  // namespace submap_slam
