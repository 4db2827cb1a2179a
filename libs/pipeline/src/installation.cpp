#include <submap_slam/pipeline/installation.h>

#include <algorithm>
#include <filesystem>

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

fs::path executableFolder() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace

std::vector<std::string> pluginFolders() {
  std::vector<std::string> folders;
  for (const char* relative : {SUBMAP_SLAM_PLUGIN_DIR, "../lib/submap-slam/plugins"}) {
    std::error_code error;
    const fs::path folder = fs::canonical(executableFolder() / relative, error);
    if (!error && std::find(folders.begin(), folders.end(), folder) == folders.end())
      folders.push_back(folder.string());
  }
  return folders;
}

std::optional<std::string> defaultIniFile() {
  const fs::path file = executableFolder() / "../share/submap-slam/ini/default.ini";
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  return file.lexically_normal().string();
}

}  // namespace submap_slam
