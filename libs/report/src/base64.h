#pragma once

#include <string>

namespace submap_slam {

/** RFC 4648, section 4, without line breaks. */
std::string base64(const std::string& bytes);

}  // namespace submap_slam
