#include <submap_slam/output/json_file.h>

#include "binary_file.h"

namespace submap_slam {

void writeJson(const std::string& file, const nlohmann::ordered_json& json) {
  constexpr int kIndent = 2;
  writeBytes(file, json.dump(kIndent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
}

}  // namespace submap_slam
