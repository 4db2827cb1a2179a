#pragma once

#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/program_errors.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** How a subcommand runs. */
struct RunOptions {
  ConfigurationOptions configuration;
  int threads = 0;  ///< 0: as many as the machine has
  bool quiet = false, overwrite = false;
};

void addPluginOption(CLI::App& command, ConfigurationOptions& options);

/** -c, --set, -p and --seed. */
void addConfigurationOptions(CLI::App& command, ConfigurationOptions& options);

/** A seed from text; throws ConfigError, beginning with `where`, if it is no whole number, 0 or more. */
uint64_t parseSeed(const std::string& text, const std::string& where);

/** --from, --to and --sensor. */
void addLogOptions(CLI::App& command, ConfigurationOptions& options);

/** --threads, --quiet and --overwrite. */
void addRunOptions(CLI::App& command, RunOptions& options);

/** --memory. */
void addMemoryOption(CLI::App& command, ConfigurationOptions& options);

/** --edits */
void addEditsOption(CLI::App& command, std::string& file);

/** Limits the number of threads while it lives; 0: as many as the machine has. */
tbb::global_control limitThreads(int threads);

/** Adds positionals `[CONFIG.ini] LOG` in either order, as MRPT's programs take them. */
void addLogPositional(CLI::App& command, std::vector<std::string>& files);

/** The log among the positionals; an ini file among them becomes the configuration. */
std::string takeLog(const std::vector<std::string>& files, ConfigurationOptions& options);

}  // namespace submap_slam
