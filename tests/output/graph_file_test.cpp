#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>

#include <limits>
#include <sstream>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {
namespace {

/** Lines of the file with the given tag, as numbers. */
std::vector<std::vector<double>> entries(const std::string& file, const std::string& tag) {
  std::vector<std::vector<double>> found;
  std::istringstream lines(readAll(file));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream columns(line);
    std::string first;
    columns >> first;
    if (first != tag) continue;
    found.emplace_back();
    for (std::string value; columns >> value;) found.back().push_back(std::stod(value));
  }
  return found;
}

Constraint constraint(uint32_t from, uint32_t to, const CPosePDFGaussian& T_a_b, bool accepted = true) {
  Constraint c;
  c.from = from, c.to = to, c.T_a_b = T_a_b, c.accepted = accepted;
  return c;
}

}  // namespace

TEST(WriteG2o, VerticesAndAcceptedEdgesAtFullPrecision) {
  const TempFolder folder;
  const double third = 1.0 / 3, seventh = 1.0 / 7;
  auto relation = gaussian(seventh, -third, 0.1);
  relation.cov(0, 1) = relation.cov(1, 0) = 0.01;
  const auto frame = gaussian(third, 2, -seventh);
  writeG2o(folder.file("a.g2o"), {gaussian(0, 0, 0), frame},
           {constraint(0, 1, relation), constraint(1, 0, relation, false)});
  EXPECT_THAT(entries(folder.file("a.g2o"), "VERTEX_SE2"),
              testing::ElementsAre(std::vector<double>{0, 0, 0, 0},
                                   std::vector<double>{1, third, 2, frame.mean.phi()}));
  EXPECT_THAT(entries(folder.file("a.g2o"), "FIX"), testing::ElementsAre(std::vector<double>{0}));
  const auto edges = entries(folder.file("a.g2o"), "EDGE_SE2");
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_THAT(std::vector<double>(edges[0].begin(), edges[0].begin() + 5),
              testing::ElementsAre(0, 1, seventh, -third, relation.mean.phi()));
  // [[0.04, 0.01], [0.01, 0.01]]⁻¹ = [[0.01, -0.01], [-0.01, 0.04]] / 0.0003, and 1 / 0.0025
  const std::vector<double> information(edges[0].begin() + 5, edges[0].end());
  EXPECT_THAT(information, testing::Pointwise(testing::DoubleNear(1e-9),
                                              {100 / 3.0, -100 / 3.0, 0.0, 400 / 3.0, 0.0, 400.0}));
}

TEST(WriteG2o, MrptReadsIt) {
  const TempFolder folder;
  writeG2o(folder.file("a.g2o"), {gaussian(0, 0, 0), gaussian(1, 2, 0.5)},
           {constraint(0, 1, gaussian(1.1, 2.1, 0.4))});
  mrpt::graphs::CNetworkOfPoses2DInf graph;
  graph.loadFromTextFile(folder.file("a.g2o"));
  ASSERT_EQ(graph.nodes.size(), 2u);
  EXPECT_NEAR(graph.nodes.at(1).y(), 2, 1e-12);
  ASSERT_EQ(graph.edges.size(), 1u);
  const auto& edge = graph.edges.begin()->second;
  EXPECT_NEAR(edge.mean.phi(), 0.4, 1e-12);
  EXPECT_NEAR(edge.cov_inv(0, 0), 25, 1e-9);
  EXPECT_NEAR(edge.cov_inv(1, 1), 100, 1e-9);
  EXPECT_NEAR(edge.cov_inv(2, 2), 400, 1e-9);
}

TEST(WriteG2o, ExactRelationHasFiniteInformation) {
  const TempFolder folder;
  const CPosePDFGaussian exact(mrpt::poses::CPose2D(1, 0, 0), mrpt::math::CMatrixDouble33::Zero());
  writeG2o(folder.file("a.g2o"), {gaussian(0, 0, 0), gaussian(1, 0, 0)}, {constraint(0, 1, exact)});
  const auto edges = entries(folder.file("a.g2o"), "EDGE_SE2");
  EXPECT_THAT(std::vector<double>(edges.at(0).begin() + 5, edges.at(0).end()),
              testing::ElementsAre(1e12, 0, 0, 1e12, 0, 1e12));
}

TEST(WriteG2o, CovarianceThatIsNotFiniteIsAnError) {
  const TempFolder folder;
  auto bad = gaussian(1, 0, 0);
  bad.cov(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { writeG2o(folder.file("a.g2o"), {gaussian(0, 0, 0)}, {constraint(4, 7, bad)}); },
              testing::ThrowsMessage<OutputError>(testing::AllOf(testing::HasSubstr(folder.file("a.g2o")),
                                                                 testing::HasSubstr("constraint 4 to 7"))));
}

}  // namespace submap_slam
