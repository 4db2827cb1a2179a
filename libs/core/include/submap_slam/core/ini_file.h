#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** A line of an ini file that says something. */
struct IniEntry {
  std::string section;
  std::string key;  ///< empty: the line is the heading of the section
  std::string value;
  std::size_t line = 0;  ///< from 1
};

/** The lines of an ini file: `[section]`, `key = value` and comments, which begin with `#`, `;` or `//`;
 * behind a value, ` ;` and ` //` begin one. Throws InputError if the file cannot be read, and ConfigError
 * naming file and line for a line of another kind and for a key that is set twice. */
std::vector<IniEntry> readIni(const std::string& file);

}  // namespace submap_slam
