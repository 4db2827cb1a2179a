# Writes a C++ file with web/page.html in which each line "@@FILE@@" is replaced by that file.
#   cmake -D SOURCE=libs/report -D OUTPUT=page_template.cpp -P embed_page.cmake
# Scripts and styles stay in files of their own for whoever reads or edits them; the pages need no other file.
file(READ ${SOURCE}/web/page.html page)
string(REGEX MATCHALL "@@[^@\n]+@@" places "${page}")
foreach(place IN LISTS places)
  string(REPLACE "@@" "" name "${place}")
  file(READ ${SOURCE}/${name} content)
  # Browsers would ask for the map when someone opens their developer tools.
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" content "${content}")
  string(REPLACE "${place}" "${content}" page "${page}")
endforeach()
file(WRITE ${OUTPUT} "#include \"page_template.h\"

namespace submap_slam {

const std::string_view kPageTemplate = R\"embedded_page(${page})embedded_page\";

}  // namespace submap_slam
")
