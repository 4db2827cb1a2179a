// What SUBMAP_SLAM_PLUGIN() would have said in a plugin built against the next interface.
#include <submap_slam/core/version.h>

extern "C" int submap_slam_plugin_interface();
extern "C" int submap_slam_plugin_interface() { return submap_slam::kPluginInterfaceVersion + 1; }
