#pragma once

#include <string>
#include <string_view>

namespace submap_slam {

/** What some editors put in front of UTF-8. */
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/** Without the blanks and line ends around it. */
inline std::string trimmed(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\n";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

}  // namespace submap_slam
