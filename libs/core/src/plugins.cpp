#include <submap_slam/core/plugins.h>

#include <dlfcn.h>
#include <fmt/format.h>
#include <mrpt/system/os.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <filesystem>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

/** Interface number that a loaded library reports; throws if it reports none. */
int interfaceOf(const std::string& path) {
  void* library = dlopen(path.c_str(), RTLD_NOLOAD | RTLD_LAZY);
  void* symbol = library ? dlsym(library, "submap_slam_plugin_interface") : nullptr;
  if (!symbol)
    throw PluginError(
        fmt::format("plugin {}: a shared library, but not a submap-slam plugin (it lacks "
                    "SUBMAP_SLAM_PLUGIN())",
                    path));
  const int number = reinterpret_cast<int (*)()>(symbol)();
  dlclose(library);
  return number;
}

}  // namespace

void loadPlugin(const std::string& file) {
  if (!fs::is_regular_file(file)) throw PluginError(fmt::format("plugin {}: no such file", file));
  const std::string path = fs::absolute(file).string();
  std::string why;
  if (!mrpt::system::loadPluginModule(path, why)) {
    why.erase(std::remove(why.begin(), why.end(), '\n'), why.end());
    throw PluginError(fmt::format("plugin {}: cannot be loaded: {}", path, why));
  }
  const int built_for = interfaceOf(path);
  if (built_for != kPluginInterfaceVersion)
    throw PluginError(fmt::format("plugin {}: built for plugin interface {}, this program has {}; rebuild it",
                                  path, built_for, kPluginInterfaceVersion));
}

void loadPluginFolder(const std::string& folder) {
  if (!fs::is_directory(folder)) return;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".so") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) loadPlugin(file);
}

std::vector<std::shared_ptr<Joiner>> availableJoiners() {
  std::vector<std::shared_ptr<Joiner>> joiners;
  for (const auto* id : mrpt::rtti::getAllRegisteredClassesChildrenOf(CLASS_ID(Joiner))) {
    if (!id->ptrCreateObject) continue;  // an abstract base
    auto joiner = std::dynamic_pointer_cast<Joiner>(id->createObject());
    if (joiner) joiners.push_back(std::move(joiner));
  }
  std::sort(joiners.begin(), joiners.end(),
            [](const auto& a, const auto& b) { return a->name() < b->name(); });
  return joiners;
}

}  // namespace submap_slam
