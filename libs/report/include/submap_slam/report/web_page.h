#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace submap_slam {

/** A self-contained HTML page: template, styles, scripts and libraries of web/ and third_party/ with the data
 * as one JSON block, each member of the data in a line of its own. Nothing in the data can end the block or
 * become markup; bytes that are not UTF-8 become the replacement character, numbers that are not finite null.
 * @param data an object; its member "kind", "run", "comparison" or "experiment", chooses what the page shows
 */
std::string webPage(const nlohmann::ordered_json& data);

}  // namespace submap_slam
