#include <submap_slam/core/ini_file.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>

#include "text.h"

namespace submap_slam {
namespace {

bool isComment(const std::string& text) {
  return text[0] == '#' || text[0] == ';' || text.compare(0, 2, "//") == 0;
}

std::string withoutComment(const std::string& value) {
  std::size_t end = value.size();
  for (const char* mark : {" ;", "\t;", " //", "\t//"}) end = std::min(end, value.find(mark));
  return trimmed(value.substr(0, end));
}

std::string headingOf(const std::string& text, const std::string& where) {
  const std::string heading = withoutComment(text);
  if (heading.back() != ']') throw ConfigError(fmt::format("{}: '{}': expected [section]", where, text));
  return trimmed(heading.substr(1, heading.size() - 2));
}

IniEntry entryOf(const std::string& text, const std::string& section, const std::string& where) {
  if (text[0] == '[') return {headingOf(text, where), "", ""};
  const auto equals = text.find('=');
  const std::string key = trimmed(text.substr(0, equals));
  if (equals == std::string::npos || key.empty())
    throw ConfigError(fmt::format("{}: '{}': expected key = value", where, text));
  if (section.empty()) throw ConfigError(fmt::format("{}: '{}': expected [section] before it", where, text));
  return {section, key, withoutComment(" " + text.substr(equals + 1))};
}

}  // namespace

std::vector<IniEntry> readIni(const std::string& file) {
  if (!std::filesystem::is_regular_file(file)) throw InputError(fmt::format("{}: no such ini file", file));
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file));
  std::vector<IniEntry> entries;
  std::map<std::pair<std::string, std::string>, std::size_t> set_in_line;
  std::string section, line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (number == 1 && line.compare(0, kByteOrderMark.size(), kByteOrderMark) == 0)
      line.erase(0, kByteOrderMark.size());
    const std::string text = trimmed(line), where = fmt::format("{}:{}", file, number);
    if (text.find('\0') != std::string::npos)
      throw ConfigError(fmt::format("{}: is no text, expected an ini file", where));
    if (text.empty() || isComment(text)) continue;
    IniEntry entry = entryOf(text, section, where);
    entry.line = number;
    section = entry.section;
    if (!entry.key.empty()) {
      const auto [before, fresh] = set_in_line.try_emplace({section, entry.key}, number);
      if (!fresh)
        throw ConfigError(
            fmt::format("{}: [{}] {} was set in line {} already", where, section, entry.key, before->second));
    }
    entries.push_back(std::move(entry));
  }
  if (in.bad()) throw InputError(fmt::format("{}: cannot be read", file));
  return entries;
}

}  // namespace submap_slam
