#include <fmt/format.h>
#include <submap_slam/output/csv_text.h>
#include <submap_slam/report/comparison.h>

#include <algorithm>

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;

/** In one line, without control characters; `digits` significant ones for numbers that are not whole. */
std::string textOf(const Json& value, int digits) {
  if (value.is_null()) return "";
  if (value.is_number_float()) return fmt::format("{:.{}g}", value.get<double>(), digits);
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/** A cell of a Markdown table. */
std::string markdownCell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell.empty() ? "–" : cell;
}

/** Number of characters of UTF-8 text. */
std::size_t characters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string padded(const std::string& cell, std::size_t width) {
  return cell + std::string(width - std::min(width, characters(cell)), ' ');
}

std::string alignedTable(const std::vector<Cells>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 3);
  for (const Cells& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], characters(row[c]));
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < widths.size(); ++c) text += "| " + padded(rows[r][c], widths[c]) + " ";
    text += "|\n";
    if (r > 0) continue;
    for (const std::size_t width : widths) text += "|" + std::string(width + 2, '-');
    text += "|\n";
  }
  return text;
}

}  // namespace

std::string markdown(const Comparison& comparison) {
  constexpr int kDigits = 5;
  std::string text;
  for (const ComparisonTable& table : comparison.tables) {
    text += fmt::format("{}## {}\n\n", text.empty() ? "" : "\n", table.title);
    if (table.rows.empty()) {
      text += "none\n";
      continue;
    }
    std::vector<Cells> rows{{""}};
    for (const auto& name : comparison.names) rows[0].push_back(markdownCell(textOf(name, kDigits)));
    for (const ComparisonRow& row : table.rows) {
      Cells cells{markdownCell(textOf(row.name, kDigits))};
      for (const Json& value : row.values) cells.push_back(markdownCell(textOf(value, kDigits)));
      rows.push_back(cells);
    }
    text += alignedTable(rows);
  }
  return text;
}

std::string csv(const Comparison& comparison) {
  constexpr int kDigits = 17;  // reads back to the same bits
  std::string text = "table,name";
  for (const auto& name : comparison.names) text += "," + quotedCsv(name);
  text += "\n";
  for (const ComparisonTable& table : comparison.tables)
    for (const ComparisonRow& row : table.rows) {
      text += quotedCsv(table.title) + "," + quotedCsv(row.name);
      for (const Json& value : row.values)
        text += "," + (value.is_string() ? quotedCsv(value.get<std::string>()) : textOf(value, kDigits));
      text += "\n";
    }
  return text;
}

}  // namespace submap_slam
