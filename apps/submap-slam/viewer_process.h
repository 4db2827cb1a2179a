#pragma once

#include <string>

namespace submap_slam {

/** Starts submap-viewer, which is beside this program, on the folder of a run; it goes on when this program
 * ends. Throws OutputError if it cannot be started. */
void startViewer(const std::string& folder);

}  // namespace submap_slam
