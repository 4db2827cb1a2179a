#pragma once

#include <string>

namespace submap_slam {

/** A field of a CSV file in quotes (RFC 4180), whatever it holds. */
std::string quotedCsv(const std::string& text);

}  // namespace submap_slam
