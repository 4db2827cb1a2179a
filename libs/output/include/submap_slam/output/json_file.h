#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace submap_slam {

/** Writes indented JSON with the keys in the order of their insertion. Numbers that are not finite become
 * null, bytes that are not UTF-8 the replacement character. Throws OutputError. */
void writeJson(const std::string& file, const nlohmann::ordered_json& json);

}  // namespace submap_slam
