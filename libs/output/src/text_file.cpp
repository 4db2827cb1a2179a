#include <submap_slam/output/text_file.h>

#include "binary_file.h"

namespace submap_slam {

void writeText(const std::string& file, const std::string& text) { writeBytes(file, text); }

}  // namespace submap_slam
