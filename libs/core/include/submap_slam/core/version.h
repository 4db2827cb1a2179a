#pragma once

namespace submap_slam {

/** Version of the library, "major.minor.patch". */
const char* version();

/** Interface that joiner plugins are built against; a plugin with another number is refused when it is
 * loaded. */
constexpr int kPluginInterfaceVersion = 6;

}  // namespace submap_slam
