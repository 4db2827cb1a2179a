#include "program_hash.h"

#include <fmt/format.h>
#include <link.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/resume_state.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "installation.h"

namespace submap_slam {
namespace fs = std::filesystem;
namespace {

/** dl_iterate_phdr calls it for each library in memory. */
int addOwnLibrary(dl_phdr_info* info, std::size_t, void* files) {
  const fs::path file = info->dlpi_name;
  if (file.filename().string().rfind("libsubmap", 0) == 0)
    static_cast<std::vector<std::string>*>(files)->push_back(file.string());
  return 0;
}

std::vector<std::string> programFiles() {
  std::vector<std::string> files{"/proc/self/exe"};
  dl_iterate_phdr(addOwnLibrary, &files);
  for (const auto& folder : pluginFolders())
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".so") files.push_back(entry.path().string());
  return files;
}

std::string contentHash(const std::string& file) {
  static std::map<std::string, std::string> known;  // the files of a program do not change while it runs
  std::string& hash = known[file];
  if (!hash.empty()) return hash;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read", file));
  return hash = textHash({std::istreambuf_iterator<char>(in), {}});
}

}  // namespace

std::string programHash(const std::vector<std::string>& plugin_files) {
  std::vector<std::string> files = programFiles();
  files.insert(files.end(), plugin_files.begin(), plugin_files.end());
  std::vector<std::string> hashes;
  std::transform(files.begin(), files.end(), std::back_inserter(hashes), contentHash);
  std::sort(hashes.begin() + 1, hashes.end());  // folders have no order
  return textHash(fmt::format("{}", fmt::join(hashes, " ")));
}

}  // namespace submap_slam
