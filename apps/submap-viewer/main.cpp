/** submap-viewer: shows rawlogs, submaps and joined maps, and joins while one looks on. */
#include <submap_slam/core/version.h>
#include <submap_slam/pipeline/program_errors.h>

#include <CLI/CLI.hpp>

#include "still_picture.h"
#include "viewer_window.h"

namespace {

using namespace submap_slam;

constexpr const char* kProgram = "submap-viewer";

void addOptions(CLI::App& app, ViewerOptions& options) {
  app.set_version_flag("--version", std::string(kProgram) + " " + version());
  app.add_option("source", options.source, "Rawlog, file of submaps, or folder of a run")
      ->type_name("FILE|OUT");
  app.add_option("--follow", options.follow, "Show the run in a folder while it goes on")->type_name("OUT");
  app.add_option("--screenshot", options.screenshot, "Write a picture and open no window; needs no display")
      ->type_name("FILE.png");
  app.add_flag("--join", options.join, "Run the chain of joiners at once");
  app.add_option("--edits", options.edits_file, "Edits to begin with, as of submap-slam join --edits")
      ->type_name("FILE");
  app.add_option("--toggle", options.layers, "Keys of layers to switch at the start, as mr (map, rejected)")
      ->type_name("KEYS");
  app.add_option("--width", options.width, "Pixels")->check(CLI::Range(64, 8192))->type_name("N");
  app.add_option("--height", options.height, "Pixels")->check(CLI::Range(64, 8192))->type_name("N");
  ConfigurationOptions& configuration = options.configuration;
  app.add_option("-c,--config", configuration.config_file, "Ini file with the joiners' parameters")
      ->type_name("CONFIG.ini");
  app.add_option("--set", configuration.settings, "Overrides one parameter; may be given several times")
      ->allow_extra_args(false)
      ->type_name("SECTION.KEY=VALUE");
  app.add_option("-p,--plugins", configuration.plugins, "Joiner plugins to load besides the installed ones")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("FILES");
  app.footer("Keys: h or F1 in the window.\nExample: submap-viewer OUT --screenshot picture.png");
}

int run(CLI::App& app, int argc, char** argv) {
  ViewerOptions options;
  addOptions(app, options);
  app.parse(argc, argv);
  if (options.source.empty() && options.follow.empty())
    throw CLI::RequiredError("a rawlog, a file of submaps, or the folder of a run");
  if (!options.screenshot.empty()) {
    makePicture(options);
  } else {
    showWindow(options);
  }
  return kSuccess;
}

int runReportingErrors(int argc, char** argv) {
  CLI::App app("Shows rawlogs, submaps and joined maps, and joins submaps while you look on.", kProgram);
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

}  // namespace

int main(int argc, char** argv) {
  try {
    return runReportingErrors(argc, argv);
  } catch (...) {  // stderr itself is gone, or memory is
    return kFailure;
  }
}
