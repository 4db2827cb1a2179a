/** The subcommands; each one's options and what it does are in the file of its name. */
#pragma once

#include <CLI/CLI.hpp>

#include "common_options.h"

namespace submap_slam {

// Each adds a subcommand that stores its exit code when it ran; errors are thrown.
void addMapCommand(CLI::App& app, int& exit_code);
void addBuildCommand(CLI::App& app, int& exit_code);
void addJoinCommand(CLI::App& app, int& exit_code);
void addEvalCommand(CLI::App& app, int& exit_code);
void addCheckCommand(CLI::App& app, int& exit_code);
void addCompareCommand(CLI::App& app, int& exit_code);
void addInfoCommand(CLI::App& app, int& exit_code);
void addImportCommand(CLI::App& app, int& exit_code);
void addSimulateCommand(CLI::App& app, int& exit_code);
void addExperimentCommand(CLI::App& app, int& exit_code);
void addParametersCommand(CLI::App& app, int& exit_code);

/** --list-joiners: the joiners of the installed plugins and of `plugin_files`. */
void listJoiners(const std::vector<std::string>& plugin_files);

}  // namespace submap_slam
