#pragma once

#include <functional>
#include <string>

namespace submap_slam {

/** Called with the share done in [0, 1] and what is being done; returns false to ask the caller to stop soon.
 */
using ProgressCallback = std::function<bool(double fraction, const std::string& what)>;

}  // namespace submap_slam
