#pragma once

#include <string>

namespace submap_slam {

/** Writes the whole file; throws OutputError naming it if anything of it did not reach the file system. */
void writeBytes(const std::string& file, const std::string& bytes);

}  // namespace submap_slam
