#include <submap_slam/core/parameters.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/ini_file.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <ostream>
#include <sstream>

#include "text.h"

namespace submap_slam {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

std::string qualified(const Parameter& p) { return fmt::format("[{}] {}", p.section, p.key); }

template <class Number>
Number parseNumber(const Parameter& p, const std::string& text, const char* expected) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    throw ConfigError(fmt::format("{} = '{}': expected {}", qualified(p), text, expected));
  return value;
}

void checkRange(const Parameter& p, double value) {
  if (value >= p.range.min && value <= p.range.max) return;
  throw ConfigError(fmt::format("{} = {}: must lie in [{}, {}]{}", qualified(p), value, p.range.min,
                                p.range.max, p.unit.empty() ? "" : " " + p.unit));
}

bool parseBool(const Parameter& p, std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* yes : {"true", "yes", "on", "1"})
    if (text == yes) return true;
  for (const char* no : {"false", "no", "off", "0"})
    if (text == no) return false;
  throw ConfigError(fmt::format("{} = '{}': expected true or false", qualified(p), text));
}

/** The words of a list separated by commas or blanks, in alphabetical order. */
std::vector<std::string> wordsOf(std::string list) {
  std::replace(list.begin(), list.end(), ',', ' ');
  std::istringstream stream(list);
  std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::sort(words.begin(), words.end());
  return words;
}

/** Choices between marks, as one may be a list. */
std::string choicesText(const Parameter& p, const char* mark) {
  const std::string between = fmt::format("{0}, {0}", mark);
  return fmt::format("{0}{1}{0}", mark, fmt::join(p.choices, between));
}

/** The choice that is meant: a list may have its words in any order, with or without blanks. */
std::string chosen(const Parameter& p, const std::string& text) {
  if (p.choices.empty()) return text;
  for (const std::string& choice : p.choices)
    if (wordsOf(choice) == wordsOf(text)) return choice;
  throw ConfigError(fmt::format("{} = '{}': expected one of {}", qualified(p), text, choicesText(p, "'")));
}

void assign(const Parameter& p, const std::string& text) {
  std::visit(
      Overloaded{[&](double* v) {
                   const auto value = parseNumber<double>(p, text, "a number");
                   checkRange(p, value);
                   *v = value;
                 },
                 [&](int* v) {
                   const auto value = parseNumber<int>(p, text, "a whole number");
                   checkRange(p, value);
                   *v = value;
                 },
                 [&](uint64_t* v) { *v = parseNumber<uint64_t>(p, text, "a whole number, 0 or more"); },
                 [&](bool* v) { *v = parseBool(p, text); }, [&](std::string* v) { *v = chosen(p, text); }},
      p.target);
}

/** Number of single-character edits between two words (Levenshtein). */
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string rangeText(const Parameter& p) {
  if (!p.choices.empty()) return choicesText(p, "`");
  const bool low = p.range.min > Range{}.min, high = p.range.max < Range{}.max;
  if (low && high) return fmt::format("{} … {}", p.range.min, p.range.max);
  if (low) return fmt::format("≥ {}", p.range.min);
  if (high) return fmt::format("≤ {}", p.range.max);
  return "";
}

}  // namespace

std::string Parameter::value() const {
  return std::visit(Overloaded{[](const bool* v) { return std::string(*v ? "true" : "false"); },
                               [](const std::string* v) { return *v; },
                               [](const auto* v) { return fmt::format("{}", *v); }},
                    target);
}

void ParameterTable::section(const std::string& name, const std::string& title) {
  sections_.push_back({name, title});
}

void ParameterTable::addTarget(const std::string& key, Parameter::Target target, const std::string& unit,
                               Range range, const std::string& description,
                               std::vector<std::string> choices) {
  if (sections_.empty()) throw std::logic_error("ParameterTable::add before section");
  parameters_.push_back({sections_.back().name, key, target, unit, description, range, std::move(choices)});
}

void ParameterTable::add(const std::string& key, double& target, const std::string& unit, Range range,
                         const std::string& description) {
  addTarget(key, &target, unit, range, description, {});
}
void ParameterTable::add(const std::string& key, int& target, const std::string& unit, Range range,
                         const std::string& description) {
  addTarget(key, &target, unit, range, description, {});
}
void ParameterTable::add(const std::string& key, uint64_t& target, const std::string& description) {
  addTarget(key, &target, "", {0, Range{}.max}, description, {});
}
void ParameterTable::add(const std::string& key, bool& target, const std::string& description) {
  addTarget(key, &target, "", {}, description, {"true", "false"});
}
void ParameterTable::add(const std::string& key, std::string& target, const std::string& description,
                         std::vector<std::string> choices) {
  addTarget(key, &target, "", {}, description, std::move(choices));
}

Parameter& ParameterTable::find(const std::string& section, const std::string& key) {
  const Parameter* nearest = nullptr;
  std::size_t best = std::string::npos;
  for (auto& p : parameters_) {
    const std::size_t distance = editDistance(p.section, section) + editDistance(p.key, key);
    if (distance == 0) return p;
    if (distance < best) best = distance, nearest = &p;
  }
  throw ConfigError(fmt::format("unknown key [{}] {}{}", section, key,
                                nearest ? fmt::format("; did you mean {}?", qualified(*nearest)) : ""));
}

void ParameterTable::checkSection(const std::string& name) const {
  const Section* nearest = nullptr;
  std::size_t best = std::string::npos;
  for (const auto& s : sections_) {
    const std::size_t distance = editDistance(s.name, name);
    if (distance == 0) return;
    if (distance < best) best = distance, nearest = &s;
  }
  throw ConfigError(fmt::format("unknown section [{}]{}", name,
                                nearest ? fmt::format("; did you mean [{}]?", nearest->name) : ""));
}

void ParameterTable::set(const std::string& section, const std::string& key, const std::string& value) {
  assign(find(section, key), trimmed(value));
}

void ParameterTable::set(const std::string& assignment) {
  const auto dot = assignment.find('.'), equals = assignment.find('=');
  if (dot == std::string::npos || equals == std::string::npos || dot > equals)
    throw ConfigError(fmt::format("'{}': expected section.key=value", assignment));
  set(trimmed(assignment.substr(0, dot)), trimmed(assignment.substr(dot + 1, equals - dot - 1)),
      assignment.substr(equals + 1));
}

void ParameterTable::loadIni(const std::string& file) {
  for (const auto& entry : readIni(file)) {
    try {
      if (entry.key.empty()) {
        checkSection(entry.section);
      } else {
        set(entry.section, entry.key, entry.value);
      }
    } catch (const ConfigError& e) {
      throw ConfigError(fmt::format("{}:{}: {}", file, entry.line, e.what()));
    }
  }
}

void ParameterTable::writeIni(std::ostream& out) const {
  for (const auto& section : sections_) {
    out << "# " << section.title << "\n[" << section.name << "]\n";
    for (const auto& p : parameters_) {
      if (p.section != section.name) continue;
      out << "# " << p.description << (p.unit.empty() ? "" : " [" + p.unit + "]") << "\n";
      out << p.key << " = " << p.value() << "\n";
    }
    out << "\n";
  }
}

void ParameterTable::writeReference(std::ostream& out) const {
  for (const auto& section : sections_) {
    out << "## [" << section.name << "]\n\n" << section.title << "\n\n";
    out << "| key | default | unit | allowed | meaning |\n|---|---|---|---|---|\n";
    for (const auto& p : parameters_)
      if (p.section == section.name)
        out << fmt::format("| `{}` | `{}` | {} | {} | {} |\n", p.key, p.value(), p.unit, rangeText(p),
                           p.description);
    out << "\n";
  }
}

}  // namespace submap_slam
