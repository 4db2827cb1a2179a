#include <submap_slam/core/errors.h>
#include <submap_slam/output/replace_file.h>

#include <filesystem>
#include <system_error>

namespace submap_slam {
namespace fs = std::filesystem;

void replaceFile(const std::string& file, const std::function<void(const std::string&)>& write) {
  const std::string part = file + ".part";
  std::error_code error;
  try {
    write(part);
  } catch (...) {
    fs::remove(part, error);
    throw;
  }
  fs::rename(part, file, error);
  if (error) throw OutputError(file + ": cannot be replaced: " + error.message());
}

}  // namespace submap_slam
