#pragma once

#include <filesystem>
#include <string>

namespace submap_slam {

/** The folder that the results of one run go to. Nothing in it is ever wiped. */
class OutputDirectory {
 public:
  /** Creates the folder and its parents if need be.
   * @param overwrite allow a folder that already holds something: files written under a name in use are
   * replaced, all others stay Throws ConfigError if the folder is not empty and `overwrite` is false, or if
   * `path` is no folder; OutputError if it cannot be created. */
  explicit OutputDirectory(const std::filesystem::path& path, bool overwrite = false);

  const std::filesystem::path& path() const { return path_; }

  /** Path of a file in this folder. */
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace submap_slam
