#pragma once

#include "viewer_options.h"

namespace submap_slam {

/** Opens the window and returns when it is closed. Throws OutputError if there is no display. */
void showWindow(const ViewerOptions& options);

}  // namespace submap_slam
