#include <fmt/format.h>
#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/errors.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <array>
#include <fstream>
#include <set>

#include "forms.h"
#include "text_lines.h"
#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

/** Places of I11 I12 I13 I22 I23 I33 among the six numbers of an edge. */
using InformationOrder = std::array<std::size_t, 6>;
constexpr InformationOrder kG2oOrder = {0, 1, 2, 3, 4, 5};
constexpr InformationOrder kToroOrder = {0, 1, 4, 2, 5, 3};  // EDGE2: I11 I12 I22 I33 I13 I23

TPose2D readPose(Words& words) {
  TPose2D pose;
  pose.x = words.number("x");
  pose.y = words.number("y");
  pose.phi = words.number("theta");
  return pose;
}

std::string poseText(const TPose2D& pose) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", pose.x, pose.y, pose.phi);
}

/** Writes each line of a graph in g2o's form. */
class GraphConverter {
 public:
  explicit GraphConverter(const ImportJob& job)
      : job_(job), out_(job.output, std::ios::binary | std::ios::trunc) {
    if (!out_) throw OutputError(job.output + ": cannot be opened for writing");
  }

  void readLine(std::string_view line) {
    Words words(line);
    const std::string_view keyword = words.next();
    if (keyword == "VERTEX_SE2" || keyword == "VERTEX2" || keyword == "VERTEX") return vertex(words);
    if (keyword == "EDGE_SE2") return edge(words, kG2oOrder);
    if (keyword == "EDGE2" || keyword == "EDGE") return edge(words, kToroOrder);
    if (keyword == "FIX") return fix(words);
    throw LineError(
        fmt::format("'{}': expected VERTEX_SE2, VERTEX2, EDGE_SE2, EDGE2 or FIX", keyword.substr(0, 40)));
  }

  void close() {
    for (const uint32_t id : named_)
      if (vertices_.count(id) == 0) ++missing_;
    if (missing_ > 0)
      job_.report.warnings.push_back(fmt::format(
          "{} vertices that edges name have no line of their own, so no pose to start from", missing_));
    out_.close();
    if (!out_) throw OutputError(job_.output + ": cannot be written");
  }

 private:
  void vertex(Words& words) {
    const uint32_t id = words.wholeNumber("the id");
    const TPose2D pose = readPose(words);
    words.requireEnd();
    if (!vertices_.insert(id).second) throw LineError(fmt::format("vertex {} was there before", id));
    out_ << fmt::format("VERTEX_SE2 {} {}\n", id, poseText(pose));
    ++job_.report.written["vertices"];
  }

  void edge(Words& words, const InformationOrder& order) {
    const uint32_t from = words.wholeNumber("the id"), to = words.wholeNumber("the id");
    if (from == to) throw LineError(fmt::format("the edge goes from {} to itself", from));
    const TPose2D T_from_to = readPose(words);
    std::array<double, 6> read{};
    for (double& element : read) element = words.number("the information matrix");
    words.requireEnd();
    std::array<double, 6> I{};
    for (std::size_t k = 0; k < I.size(); ++k) I[k] = read[order[k]];
    requirePositive(I);
    named_.insert({from, to});
    out_ << fmt::format("EDGE_SE2 {} {} {} {:.17g}\n", from, to, poseText(T_from_to), fmt::join(I, " "));
    ++job_.report.written["edges"];
  }

  /** TORO's and g2o's order hold different matrices in most files; the wrong one is often not positive. */
  static void requirePositive(const std::array<double, 6>& I) {
    Eigen::Matrix3d matrix;
    matrix << I[0], I[1], I[2], I[1], I[3], I[4], I[2], I[4], I[5];
    if (matrix.llt().info() != Eigen::Success)
      throw LineError("the information matrix is not positive definite");
  }

  void fix(Words& words) {
    const uint32_t id = words.wholeNumber("the id");
    words.requireEnd();
    out_ << fmt::format("FIX {}\n", id);
  }

  ImportJob job_;
  std::ofstream out_;
  std::set<uint32_t> vertices_, named_;
  std::size_t missing_ = 0;
};

}  // namespace

bool isGraphKeyword(std::string_view word) {
  return word == "VERTEX_SE2" || word == "VERTEX2" || word == "VERTEX" || word == "EDGE_SE2" ||
         word == "EDGE2" || word == "EDGE" || word == "FIX";
}

void importGraph(const ImportJob& job) {
  GraphConverter converter(job);
  forEachLine(
      job.file, [&](std::string_view line) { converter.readLine(line); }, &job.report, job.progress);
  converter.close();
}

}  // namespace submap_slam
