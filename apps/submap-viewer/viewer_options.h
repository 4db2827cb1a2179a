#pragma once

#include <submap_slam/pipeline/configuration.h>

#include <string>

namespace submap_slam {

/** What the user said on the command line. */
struct ViewerOptions {
  std::string source;                   ///< rawlog, file of submaps, or folder of a run; may be empty
  std::string follow;                   ///< folder of a run that goes on
  std::string screenshot;               ///< picture to make without a window
  std::string edits_file;               ///< to begin with
  std::string layers;                   ///< letters of layers to switch before the first look
  unsigned width = 1280, height = 800;  ///< pixels
  bool join = false;                    ///< run the chain of joiners at once
  ConfigurationOptions configuration;
};

}  // namespace submap_slam
