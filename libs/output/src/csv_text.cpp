#include <submap_slam/output/csv_text.h>

namespace submap_slam {

std::string quotedCsv(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace submap_slam
