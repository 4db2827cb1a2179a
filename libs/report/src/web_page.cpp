#include <submap_slam/report/web_page.h>

#include <stdexcept>

#include "page_template.h"

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/** JSON that is safe inside of a script element: without '<' nothing can end it or begin a comment. */
std::string embeddable(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string oneMemberPerLine(const Json& data) {
  std::string text = "{\n";
  for (const auto& [key, value] : data.items())
    text += (text.size() > 2 ? ",\n" : "") + dumped(Json(key)) + ":" + dumped(value);
  return text + "\n}";
}

}  // namespace

std::string webPage(const Json& data) {
  const std::size_t at = kPageTemplate.find(kDataPlaceholder);
  if (at == std::string_view::npos) throw std::logic_error("the page template has no place for data");
  const std::string_view before = kPageTemplate.substr(0, at),
                         after = kPageTemplate.substr(at + kDataPlaceholder.size());
  return std::string(before) + embeddable(oneMemberPerLine(data)) + std::string(after);
}

}  // namespace submap_slam
