#include <submap_slam/core/errors.h>
#include <submap_slam/output/output_directory.h>

#include <system_error>

namespace fs = std::filesystem;

namespace submap_slam {

OutputDirectory::OutputDirectory(const fs::path& path, bool overwrite) : path_(path) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw ConfigError(path.string() + ": is a file, expected a folder for the results");
  fs::create_directories(path, error);
  if (error) throw OutputError(path.string() + ": cannot be created: " + error.message());
  const bool empty = fs::is_empty(path, error);
  if (error) throw OutputError(path.string() + ": cannot be read: " + error.message());
  if (!empty && !overwrite)
    throw ConfigError(path.string() +
                      ": is not empty; give another folder, or --overwrite to replace the results in it");
}

}  // namespace submap_slam
