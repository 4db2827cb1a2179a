#pragma once

#include "viewer_options.h"

namespace submap_slam {

/** --screenshot: what the window would show, into a file, without any display. */
void makePicture(const ViewerOptions& options);

}  // namespace submap_slam
