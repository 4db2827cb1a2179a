#include "viewer_process.h"

#include <fmt/format.h>
#include <spawn.h>
#include <submap_slam/core/errors.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>

namespace submap_slam {

void startViewer(const std::string& folder) {
  const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::string program = (here / "submap-viewer").string(), option = "--follow", argument = folder;
  const std::array<char*, 4> arguments{program.data(), option.data(), argument.data(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // Ctrl-C is for the run alone
  pid_t child = 0;
  const int error = posix_spawn(&child, program.c_str(), nullptr, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (error != 0)
    throw OutputError(fmt::format("--view: {} cannot be started: {}", program, std::strerror(error)));
}

}  // namespace submap_slam
