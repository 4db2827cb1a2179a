#pragma once

#include <string>
#include <vector>

namespace submap_slam {

/** 16 hex digits that identify the running build: the content of the program, of the project's libraries that
 * it has loaded, of all plugins of the installation and of `plugin_files`. Throws InputError if one of these
 * cannot be read. */
std::string programHash(const std::vector<std::string>& plugin_files);

}  // namespace submap_slam
