#include <submap_slam/pipeline/printable.h>

#include <string_view>

namespace submap_slam {
namespace {

constexpr std::size_t kLongestMessage = 1000;  // bytes; leaves room for paths

bool isContinuation(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

/** Bytes of the UTF-8 character at the front; 0 if there is none. */
std::size_t characterBytes(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const std::size_t bytes = first < 0x80           ? 1
                            : (first >> 5) == 0x06 ? 2
                            : (first >> 4) == 0x0e ? 3
                            : (first >> 3) == 0x1e ? 4
                                                   : 0;
  if (bytes > text.size()) return 0;
  for (std::size_t i = 1; i < bytes; ++i)
    if (!isContinuation(text[i])) return 0;
  return bytes;
}

bool isControl(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]);
  const bool second_set =
      first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;  // U+0080 … U+009F
  return first < 0x20 || first == 0x7f || second_set;
}

}  // namespace

std::string printable(const std::string& text) {
  std::string_view rest = text;
  std::string result;
  while (!rest.empty()) {
    if (result.size() >= kLongestMessage) return result + " …";
    const std::size_t bytes = characterBytes(rest);
    const std::string_view character = rest.substr(0, bytes == 0 ? 1 : bytes);
    if (character == "\n") {
      result += ' ';
    } else if (bytes == 0 || isControl(character)) {
      result += '?';
    } else {
      result += character;
    }
    rest.remove_prefix(character.size());
  }
  return result;
}

}  // namespace submap_slam
