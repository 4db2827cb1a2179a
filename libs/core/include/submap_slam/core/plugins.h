#pragma once

#include <submap_slam/core/joiner.h>

#include <memory>
#include <string>
#include <vector>

namespace submap_slam {

/** Loads one plugin library; throws PluginError naming the file if it is missing, no plugin, or was built for
 * another interface version. Loading the same file twice is harmless. */
void loadPlugin(const std::string& file);

/** Loads every *.so of a folder in alphabetical order; a folder that does not exist holds none. */
void loadPluginFolder(const std::string& folder);

/** One new object of each joiner class that is registered, for submaps of either form, sorted by name. */
std::vector<std::shared_ptr<Joiner>> availableJoiners();

}  // namespace submap_slam
