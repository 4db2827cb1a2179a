/** submap-slam: makes large, accurate 2D maps from MRPT rawlogs by building and joining submaps. */
#include <malloc.h>
#include <submap_slam/core/version.h>
#include <submap_slam/pipeline/program_errors.h>

#include "commands.h"
#include "stop_signal.h"

namespace {

using namespace submap_slam;

constexpr const char* kProgram = "submap-slam";

/** Parses the command line and does what it says. */
int run(CLI::App& app, int argc, char** argv) {
  int exit_code = kSuccess;
  bool list_joiners = false;
  ConfigurationOptions options;

  app.set_version_flag("--version", std::string(kProgram) + " " + version());
  app.add_flag("--list-joiners", list_joiners, "List the joiners that the plugins offer");
  addPluginOption(app, options);
  app.require_subcommand(0, 1);
  app.footer(
      "Example: submap-slam map LOG.rawlog -o out     then look at out/map.png\n"
      "Help on a subcommand: submap-slam map --help");

  addMapCommand(app, exit_code);
  addBuildCommand(app, exit_code);
  addJoinCommand(app, exit_code);
  addEvalCommand(app, exit_code);
  addCheckCommand(app, exit_code);
  addImportCommand(app, exit_code);
  addCompareCommand(app, exit_code);
  addInfoCommand(app, exit_code);
  addSimulateCommand(app, exit_code);
  addExperimentCommand(app, exit_code);
  addParametersCommand(app, exit_code);

  app.parse(argc, argv);
  if (list_joiners) {
    listJoiners(options.plugins);
  } else if (app.get_subcommands().empty()) {
    throw CLI::RequiredError("a subcommand (see submap-slam --help)");
  }
  return exit_code;
}

/** Every error ends in one line on stderr and an exit code. */
int runReportingErrors(int argc, char** argv) {
  CLI::App app("Makes large, accurate 2D maps from MRPT rawlogs by building and joining submaps.", kProgram);
  try {
    return run(app, argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return reportError(kProgram, e.what(), kBadInput);
  } catch (...) {
    return reportCaughtError(kProgram);
  }
}

/** Submaps come and go: their memory is kept for the next one, because pages that the system gives anew cost
 * more than what is done with them. Only what is larger, such as global maps, goes back when it is freed; by
 * default glibc raises that limit with each such block until the heap grows full of holes. */
void keepMemoryOfSubmaps() {
  constexpr int kBigBlock_bytes = 8 << 20, kFreeAtEnd_bytes = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, kBigBlock_bytes);
  mallopt(M_TRIM_THRESHOLD, kFreeAtEnd_bytes);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    keepMemoryOfSubmaps();
    catchStopSignals();
    return runReportingErrors(argc, argv);
  } catch (...) {  // stderr itself is gone, or memory is
    return kFailure;
  }
}
