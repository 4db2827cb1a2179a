#include "words.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace submap_slam {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::size_t kMostShown = 40;  // characters of a word in a message

std::optional<double> parseNumber(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, value);
  if (text.empty() || error != std::errc() || parsed != end) return std::nullopt;
  return value;
}

[[noreturn]] void fail(std::string_view word, const char* what, const char* kind) {
  if (word.empty()) throw LineError(fmt::format("the line ends before {}", what));
  throw LineError(fmt::format("'{}' for {}: expected {}", word.substr(0, kMostShown), what, kind));
}

}  // namespace

std::string_view Words::next() {
  const std::size_t begin = rest_.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return rest_ = {};
  rest_.remove_prefix(begin);
  const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(word.size());
  return word;
}

std::size_t Words::left() const {
  Words copy = *this;
  std::size_t count = 0;
  while (!copy.next().empty()) ++count;
  return count;
}

double Words::anyNumber(const char* what) {
  const std::string_view word = next();
  const auto value = parseNumber(word);
  if (!value) fail(word, what, "a number");
  return *value;
}

double Words::number(const char* what) {
  const std::string_view word = next();
  const auto value = parseNumber(word);
  if (!value || !std::isfinite(*value)) fail(word, what, "a finite number");
  return *value;
}

uint32_t Words::wholeNumber(const char* what) {
  const std::string_view word = next();
  uint32_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [parsed, error] = std::from_chars(word.data(), end, value);
  if (word.empty() || error != std::errc() || parsed != end) fail(word, what, "a whole number, 0 or more");
  return value;
}

void Words::requireEnd() {
  const std::string_view word = next();
  if (!word.empty())
    throw LineError(
        fmt::format("'{}': nothing was expected behind the last number", word.substr(0, kMostShown)));
}

bool isNumber(std::string_view text) { return parseNumber(text).has_value(); }

}  // namespace submap_slam
