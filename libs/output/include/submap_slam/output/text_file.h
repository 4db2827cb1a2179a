#pragma once

#include <string>

namespace submap_slam {

/** Writes the text as it is and replaces what the file held. Throws OutputError naming the file if anything
 * of it did not reach the file system. */
void writeText(const std::string& file, const std::string& text);

}  // namespace submap_slam
