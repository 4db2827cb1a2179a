#include <gmock/gmock.h>
#include <submap_slam/report/web_page.h>

#include <algorithm>
#include <limits>
#include <string>

#include "base64.h"

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;

/** The text of the element with the data. */
std::string dataBlock(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return page.substr(from, page.find("</script>", from) - from);
}

TEST(WebPage, DataComeBackWhateverTheyHold) {
  const Json data{{"kind", "run"},
                  {"ini", "a = </script><script>alert(1)</script> <!-- & \" ' \\ \u2028 \n"},
                  {"</script>", {1, 2.5, nullptr}}};
  const std::string block = dataBlock(webPage(data));
  EXPECT_EQ(Json::parse(block), data);
  EXPECT_THAT(block, Not(HasSubstr("<")));
}

TEST(WebPage, BytesThatAreNoTextAndNumbersThatAreNotFiniteDoNoHarm) {
  const Json read = Json::parse(
      dataBlock(webPage({{"text", "a\xff z"}, {"number", std::numeric_limits<double>::infinity()}})));
  EXPECT_EQ(read["text"], "a\uFFFD z");
  EXPECT_TRUE(read["number"].is_null());
}

TEST(WebPage, EachMemberHasItsLine) {
  EXPECT_EQ(dataBlock(webPage({{"a", 1}, {"b", {{"c", 2}}}})), "\n{\n\"a\":1,\n\"b\":{\"c\":2}\n}\n");
}

TEST(WebPage, HoldsItsPartsAndTheirLicencesAndLoadsNothing) {
  const std::string page = webPage({{"kind", "run"}});
  for (const char* text : {"Leaflet 1.9.4", "var uPlot=", "BSD 2-Clause License", "The MIT License",
                           "function showRun", "default-src 'none'"})
    EXPECT_THAT(page, HasSubstr(text));
  for (const char* text : {"@@", "<link", "<script src", "@import", "sourceMappingURL"})
    EXPECT_THAT(page, Not(HasSubstr(text)));
}

TEST(Base64, VectorsOfRfc4648) {
  const char* const vectors[][2] = {{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64(std::string("\0\xff\xfe", 3)), "AP/+");
}

}  // namespace
}  // namespace submap_slam
