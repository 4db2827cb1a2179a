#pragma once

#include <string>

namespace submap_slam {

/** A message for a terminal in one line: control characters and bytes that are no UTF-8, as binary files
 * bring them into messages, become '?', and what is too long for a message is cut. */
std::string printable(const std::string& text);

}  // namespace submap_slam
