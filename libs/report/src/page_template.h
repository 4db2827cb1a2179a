#pragma once

#include <string_view>

namespace submap_slam {

/** web/page.html with styles, scripts and libraries put in; made by embed_page.cmake. */
extern const std::string_view kPageTemplate;

/** Stands in the template where the data go. */
constexpr std::string_view kDataPlaceholder = "@DATA@";

}  // namespace submap_slam
