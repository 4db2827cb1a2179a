#include "common_options.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <tbb/info.h>

#include <charconv>

namespace submap_slam {
namespace {

bool isIni(const std::string& file) {
  return file.size() > 4 && file.compare(file.size() - 4, 4, ".ini") == 0;
}

}  // namespace

void addPluginOption(CLI::App& command, ConfigurationOptions& options) {
  command
      .add_option("-p,--plugins", options.plugins,
                  "Joiner plugins to load besides the installed ones: a.so,b.so")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FILES")
      ->group("Configuration");
}

void addConfigurationOptions(CLI::App& command, ConfigurationOptions& options) {
  const char* group = "Configuration";
  command
      .add_option("-c,--config", options.config_file, "Ini file (default: default.ini of the installation)")
      ->type_name("CONFIG.ini")
      ->group(group);
  command.add_option("--set", options.settings, "Overrides one parameter; may be given several times")
      ->allow_extra_args(false)
      ->type_name("SECTION.KEY=VALUE")
      ->group(group);
  addPluginOption(command, options);
  command
      .add_option_function<std::string>(
          "--seed", [&options](const std::string& seed) { options.settings.push_back("run.seed=" + seed); },
          "Seed of the random streams, as --set run.seed=N")
      ->type_name("N")
      ->group(group);
}

uint64_t parseSeed(const std::string& text, const std::string& where) {
  uint64_t seed = 0;
  const char* const text_end = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), text_end, seed);
  if (error == std::errc::result_out_of_range)
    throw ConfigError(fmt::format("{}: '{}' is too large", where, text));
  if (error != std::errc() || end != text_end)
    throw ConfigError(fmt::format("{}: '{}' is not a whole number, 0 or more", where, text));
  return seed;
}

void addLogOptions(CLI::App& command, ConfigurationOptions& options) {
  const char* group = "Part of the log";
  command
      .add_option("--from", options.from, "First rawlog entry, or seconds from the start with a trailing s")
      ->type_name("N|Ts")
      ->group(group);
  command.add_option("--to", options.to, "Where to stop, in the same form")->type_name("N|Ts")->group(group);
  command
      .add_option("--sensor", options.sensor_labels, "Labels of the 2D scanners to use: a,b (default: all)")
      ->type_name("LABELS")
      ->group(group);
}

void addRunOptions(CLI::App& command, RunOptions& options) {
  const char* group = "Run";
  command
      .add_option("--threads", options.threads,
                  "Number of threads (default: all); the result is the same for any")
      ->check(CLI::Range(1, 1024))
      ->type_name("N")
      ->group(group);
  command.add_flag("-q,--quiet", options.quiet, "No progress and no summary")->group(group);
  command.add_flag("--overwrite", options.overwrite, "Start anew and replace results that exist")
      ->group(group);
}

void addMemoryOption(CLI::App& command, ConfigurationOptions& options) {
  command
      .add_option_function<uint64_t>(
          "--memory",
          [&options](uint64_t bytes) {
            options.settings.push_back(fmt::format("joining.memory={}", static_cast<double>(bytes) / 1e6));
          },
          "About how much memory joining may take, as 500MB or 2GB; as --set joining.memory=MB")
      ->transform(CLI::AsSizeValue(true))
      ->type_name("SIZE")
      ->group("Run");
}

void addEditsOption(CLI::App& command, std::string& file) {
  command
      .add_option("--edits", file,
                  "What you change by hand, one a line: reject FROM TO | add FROM TO X Y PHI [SIGMA_XY "
                  "SIGMA_PHI] | fix ID X Y PHI | mask ID (ids of submaps, m, rad)")
      ->type_name("FILE")
      ->group("Run");
}

tbb::global_control limitThreads(int threads) {
  const int count = threads > 0 ? threads : tbb::info::default_concurrency();
  return {tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)};
}

void addLogPositional(CLI::App& command, std::vector<std::string>& files) {
  command.add_option("log", files, "Rawlog, before or after an ini file if one is given")
      ->required()
      ->type_name("[CONFIG.ini] LOG.rawlog");
}

std::string takeLog(const std::vector<std::string>& files, ConfigurationOptions& options) {
  std::string log;
  for (const auto& file : files) {
    std::string& target = isIni(file) ? options.config_file : log;
    if (!target.empty())
      throw ConfigError(fmt::format("'{}' and '{}' given; only one is possible", target, file));
    target = file;
  }
  if (log.empty()) throw ConfigError("no rawlog given");
  if (holdsLandmarkSubmaps(log))
    throw InputError(
        fmt::format("{}: holds landmark submaps, for 'submap-slam info' and 'join'; expected a rawlog "
                    "with measurements",
                    log));
  return log;
}

}  // namespace submap_slam
