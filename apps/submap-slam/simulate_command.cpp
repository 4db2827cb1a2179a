#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <filesystem>
#include <memory>

#include "commands.h"
#include "common_options.h"
#include "simulation_files.h"
#include "terminal_reporter.h"

namespace submap_slam {
namespace {

struct SimulateOptions {
  std::string world, prefix, ini_file, seed = "1";
  std::vector<std::string> settings;
  bool actions = false, overwrite = false, quiet = false;
};

void refuseExisting(const SimulationFiles& files) {
  for (const auto& file : files.all())
    if (std::filesystem::exists(file))
      throw ConfigError(fmt::format("{}: exists; use --overwrite to replace it", file));
}

int runSimulate(const SimulateOptions& options) {
  const uint64_t seed = parseSeed(options.seed, "--seed");
  const Scenario scenario = loadScenario(options.world, options.ini_file, options.settings);
  const SimulationFiles files(options.prefix, scenario);
  if (!options.overwrite) refuseExisting(files);
  const RawlogForm form = options.actions ? RawlogForm::kActions : RawlogForm::kObservations;
  const std::size_t scans = writeSimulation(scenario, seed, form, files);
  std::string note = fmt::format("{} scans, {:.1f} s\nlog: {}\ntruth: {}\nodometry: {}", scans,
                                 static_cast<double>(scans - 1) / scenario.scan_rate, files.log, files.truth,
                                 files.odometry);
  if (!files.map_ini.empty())
    note += fmt::format("\nto map it: submap-slam map {} {} -o OUT", files.map_ini, files.log);
  TerminalReporter(options.quiet).note(note);
  return kSuccess;
}

}  // namespace

void addSimulateCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate", "Simulates a rawlog with ground truth");
  command->add_option("world", options->world, "Where the robot drives (see below)")
      ->required()
      ->type_name("WORLD");
  command
      ->add_option(
          "-o,--output", options->prefix,
          "Writes PREFIX.rawlog, PREFIX.truth.tum, PREFIX.odometry.tum and PREFIX.ini; of worlds with "
          "landmarks also PREFIX.landmarks.csv, and PREFIX.map.ini for map")
      ->required()
      ->type_name("PREFIX");
  command->add_option("--seed", options->seed, "Seed of the noise")->capture_default_str()->type_name("N");
  command->add_flag("--actions", options->actions,
                    "Actions and sensory frames instead of time-stamped observations");
  command->add_option("-c,--config", options->ini_file, "Ini file with a section [simulation]")
      ->type_name("CONFIG.ini")
      ->group("Configuration");
  command->add_option("--set", options->settings, "Overrides one parameter; may be given several times")
      ->allow_extra_args(false)
      ->type_name("simulation.KEY=VALUE")
      ->group("Configuration");
  command->add_flag("-q,--quiet", options->quiet, "No summary")->group("Run");
  command->add_flag("--overwrite", options->overwrite, "Replace files that exist")->group("Run");
  command->footer(
      fmt::format("Worlds: {}\n"
                  "PREFIX.ini lists all keys of [simulation] with the values used, for -c of this command.\n"
                  "Example: submap-slam simulate non_convex -o sim1 --seed 3",
                  fmt::join(scenarioNames(), ", ")));
  command->callback([options, &exit_code] { exit_code = runSimulate(*options); });
}

}  // namespace submap_slam
