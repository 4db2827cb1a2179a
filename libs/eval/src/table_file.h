#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** A line of numbers. */
struct TableRow {
  std::size_t line = 0;  ///< in the file, from 1
  std::vector<double> values;
};

/** The lines that hold anything: numbers apart by blanks or commas, further columns ignored, `#` starts a
 * comment. Throws InputError naming file and line for a line that is too short or holds something else than
 * finite numbers; also if the file cannot be read or has no such line.
 * @param columns what they are, apart by blanks or commas, and so how many
 * @param headed  the first line must be `columns`, as in CSV files, and a table without other lines is none
 *                of the errors */
std::vector<TableRow> readTable(const std::string& file, const std::string& columns, bool headed = false);

}  // namespace submap_slam
