#include "table_file.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

namespace submap_slam {
namespace {

/** Cuts the next column off the front of the text; empty at the end. */
std::string_view nextColumn(std::string_view& text) {
  constexpr std::string_view kBetween = " \t\r\f\v,";
  text.remove_prefix(std::min(text.find_first_not_of(kBetween), text.size()));
  const auto column = text.substr(0, text.find_first_of(kBetween));
  text.remove_prefix(column.size());
  return column;
}

std::size_t countOf(std::string_view columns) {
  std::size_t count = 0;
  while (!nextColumn(columns).empty()) ++count;
  return count;
}

std::optional<double> toNumber(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/** Nothing for a blank line. */
std::optional<TableRow> parseLine(std::string_view text, const std::string& where,
                                  const std::string& columns) {
  if (text.find('\0') != std::string_view::npos)
    throw InputError(fmt::format("{}: is no text, expected lines of {}", where, columns));
  text = text.substr(0, text.find('#'));
  TableRow row;
  const std::size_t count = countOf(columns);
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = nextColumn(text);
    if (column.empty() && i == 0) return {};
    if (column.empty())
      throw InputError(fmt::format("{}: {} columns, expected {}: {}", where, i, count, columns));
    const auto value = toNumber(column);
    if (!value)
      throw InputError(fmt::format("{}: '{}' is not a finite number, expected {}", where, column, columns));
    row.values.push_back(*value);
  }
  return row;
}

}  // namespace

std::vector<TableRow> readTable(const std::string& file, const std::string& columns, bool headed) {
  std::ifstream in(file);
  if (!in) throw InputError(file + ": cannot be opened");
  std::vector<TableRow> rows;
  std::string text;
  std::size_t line = 1;
  if (headed) {
    std::getline(in, text);
    if (text.substr(0, text.find('\r')) != columns)
      throw InputError(fmt::format("{}:1: expected the head {}", file, columns));
    ++line;
  }
  for (; std::getline(in, text); ++line)
    if (auto row = parseLine(text, fmt::format("{}:{}", file, line), columns)) {
      row->line = line;
      rows.push_back(*row);
    }
  if (in.bad()) throw InputError(file + ": cannot be read");
  if (rows.empty() && !headed) throw InputError(file + ": holds no data, expected lines of " + columns);
  return rows;
}

}  // namespace submap_slam
