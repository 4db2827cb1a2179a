#include "experiment_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>

namespace submap_slam {

std::vector<IniEntry> ExperimentFile::keysOf(const std::string& section) const {
  std::vector<IniEntry> keys;
  std::copy_if(entries_.begin(), entries_.end(), std::back_inserter(keys),
               [&](const IniEntry& e) { return e.section == section && !e.key.empty(); });
  return keys;
}

const IniEntry& ExperimentFile::headingOf(const std::string& section, const std::string& list) const {
  const auto heading =
      std::find_if(entries_.begin(), entries_.end(), [&](const IniEntry& e) { return e.section == section; });
  if (heading == entries_.end())
    throw ConfigError(fmt::format("[experiment] {}: there is no section [{}]", list, section));
  return *heading;
}

std::string assignmentOf(const IniEntry& entry) { return fmt::format("{}={}", entry.key, entry.value); }

void requireName(const std::string& name) {
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  if (!std::all_of(name.begin(), name.end(), allowed))
    throw ConfigError(fmt::format("[experiment]: '{}' must consist of letters, digits, - and _", name));
}

bool startsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

std::vector<std::string> wordsOf(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

}  // namespace submap_slam
