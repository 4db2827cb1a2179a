#include "imported.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;

struct Converted {
  ImportReport report;
  std::string text;
};

Converted convert(const std::string& text) {
  const TempFolder temp;
  Converted result;
  result.report = importFile(temp.write("a.graph", text), temp.file("out.g2o"), {}, {});
  result.text = readAll(temp.file("out.g2o"));
  return result;
}

TEST(Graph, ToroEdgesAreReordered) {
  // TORO: I11 I12 I22 I33 I13 I23; g2o: I11 I12 I13 I22 I23 I33
  const auto graph = convert("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0.5\nEDGE2 0 1 1 0 0.5 11 1 22 33 2 3\n");
  EXPECT_EQ(graph.text, "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.5\nEDGE_SE2 0 1 1 0 0.5 11 1 2 22 3 33\n");
  EXPECT_EQ(graph.report.written.at("vertices"), 2u);
  EXPECT_EQ(graph.report.written.at("edges"), 1u);
}

TEST(Graph, G2oStaysAsItIs) {
  const std::string text =
      "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.5\nFIX 0\nEDGE_SE2 0 1 1 0 0.5 11 1 2 22 3 33\n";
  EXPECT_EQ(convert(text).text, text);
}

TEST(Graph, NumbersKeepTheirBits) {
  EXPECT_THAT(convert("VERTEX2 7 0.1 1e-17 -3.141592653589793\n").text,
              HasSubstr("7 0.10000000000000001 1.0000000000000001e-17 -3.1415926535897931"));
}

TEST(Graph, DamagedLinesAreLeftOut) {
  const auto graph = convert(
      "VERTEX2 0 0 0 0\nVERTEX2 0 1 0 0\nEDGE2 0 0 1 0 0 1 0 1 1 0 0\nEDGE2 0 1 1 0 0 1 5 1 1 0 0\n"
      "EDGE2 0 1 1 0 0 1 0 1\nEDGE2 0 1 1 0 0 1 0 1 1 0 0\n");
  ASSERT_EQ(graph.report.damaged_lines, 4u);
  EXPECT_THAT(graph.report.damage[0], HasSubstr("a.graph:2: vertex 0 was there before"));
  EXPECT_THAT(graph.report.damage[1], HasSubstr("from 0 to itself"));
  EXPECT_THAT(graph.report.damage[2], HasSubstr("not positive definite"));
  EXPECT_THAT(graph.report.damage[3], HasSubstr("the line ends before the information matrix"));
  EXPECT_THAT(graph.report.warnings.at(0), HasSubstr("1 vertices that edges name"));
}

}  // namespace
}  // namespace submap_slam
