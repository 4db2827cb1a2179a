#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** A line of eight numbers; both TUM and relations files consist of them. */
struct TableRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::array<double, 8> values{};
};

/** The lines that hold anything: numbers apart by blanks or commas, further columns ignored, `#` starts a
 * comment. Throws InputError naming file and line for a line that is too short or holds something else than
 * finite numbers; also if the file cannot be read or has no such line.
 * @param columns what they are, for the error text */
std::vector<TableRow> readTable(const std::string& file, const std::string& columns);

}  // namespace submap_slam
