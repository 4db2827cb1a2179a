/** Where the files that belong to the program are; all paths are found from the place of the executable. */
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

/** The folders that are searched for joiner plugins, each once; only those that exist. */
std::vector<std::string> pluginFolders();

/** share/submap-slam/ini/default.ini of this installation, if it is there. */
std::optional<std::string> defaultIniFile();

}  // namespace submap_slam
