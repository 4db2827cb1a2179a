#include "landmark_text.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <charconv>
#include <cmath>

namespace submap_slam {
namespace {

constexpr uint32_t kMaxDimension = 3 + 2 * kMostFeatures;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

void LandmarkText::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_number_, what));
}

/** Takes the next line; false at the end of the text. */
bool LandmarkText::readLine() {
  if (text_.empty()) return false;
  const std::size_t end = text_.find('\n');
  line_ = text_.substr(0, end);
  text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
  ++line_number_;
  return true;
}

void LandmarkText::requireLine(const std::string& expected) {
  if (readLine()) return;
  ++line_number_;
  fail("the file ends here; expected " + expected);
}

/** The next word of the line; empty at its end. */
std::string_view LandmarkText::word() {
  std::size_t begin = 0;
  while (begin < line_.size() && isBlank(line_[begin])) ++begin;
  std::size_t end = begin;
  while (end < line_.size() && !isBlank(line_[end])) ++end;
  const std::string_view found = line_.substr(begin, end - begin);
  line_.remove_prefix(end);
  return found;
}

double LandmarkText::number() {
  const std::string_view text = word();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty()) fail("expected another number in this line");
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    fail(fmt::format("'{}': expected a finite number", text.substr(0, 40)));
  return value;
}

uint32_t LandmarkText::wholeNumber(const std::string& expected) {
  const std::string_view text = word();
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    fail(fmt::format("'{}': expected {}", text.substr(0, 40), expected));
  return value;
}

void LandmarkText::requireEndOfLine(const std::string& expected) {
  const std::string_view rest = word();
  if (!rest.empty()) fail(fmt::format("'{}': expected {}", rest.substr(0, 40), expected));
}

LandmarkSubmap::Ptr LandmarkText::next() {
  std::string_view heading;
  while (heading.empty() || heading.front() == '#') {
    if (!readLine()) return nullptr;
    heading = word();
  }
  const std::size_t first_line = line_number_;
  if (heading != "MAP") fail(fmt::format("'{}': expected 'MAP k n'", heading.substr(0, 40)));
  const uint32_t number = wholeNumber("the number of the submap");
  if (number != submaps_ + 1) fail(fmt::format("submap {}: expected {}", number, submaps_ + 1));
  const uint32_t dimension = wholeNumber("the dimension of the state");
  if (dimension < 3 || dimension % 2 == 0 || dimension > kMaxDimension)
    fail(fmt::format("dimension {}: expected 3 + 2 n for n features, at most {}", dimension, kMaxDimension));
  requireEndOfLine("nothing behind 'MAP k n'");

  auto submap = LandmarkSubmap::Create();
  submap->id = submaps_++;
  readState(*submap, dimension);
  readCovariance(*submap, dimension);
  try {
    requireUsable(*submap);
  } catch (const InputError& error) {
    line_number_ = first_line;
    fail(fmt::format("submap {}: {}", number, error.what()));
  }
  return submap;
}

/** One line `id value`. */
double LandmarkText::stateElement(const char* what, uint32_t& id) {
  requireLine(fmt::format("'id value' with {}", what));
  id = wholeNumber("the id of a feature, or 0 for the end pose");
  const double value = number();
  requireEndOfLine("nothing behind 'id value'");
  return value;
}

void LandmarkText::readState(LandmarkSubmap& submap, uint32_t dimension) {
  uint32_t id = 0;
  const auto pose_element = [&](const char* what) {
    const double value = stateElement(what, id);
    if (id != 0) fail(fmt::format("id {}: expected 0 and {}", id, what));
    return value;
  };
  submap.end_pose.x = pose_element("x of the end pose");
  submap.end_pose.y = pose_element("y of the end pose");
  submap.end_pose.phi = pose_element("the heading of the end pose");
  submap.features.resize((dimension - 3) / 2);
  for (auto& feature : submap.features) {
    feature.x = stateElement("x of a feature", feature.id);
    if (feature.id == 0) fail("id 0: expected that of a feature; the end pose has three lines");
    feature.y = stateElement("y of a feature", id);
    if (id != feature.id) fail(fmt::format("id {}: expected y of feature {}", id, feature.id));
  }
}

void LandmarkText::readCovariance(LandmarkSubmap& submap, uint32_t dimension) {
  submap.covariance = mrpt::math::CMatrixDouble(dimension, dimension);
  for (std::size_t row = 0; row < dimension; ++row) {
    const std::string expected =
        fmt::format("row {} of the covariance of submap {} with {} numbers", row + 1, submaps_, row + 1);
    requireLine(expected);
    for (std::size_t column = 0; column <= row; ++column)
      submap.covariance(row, column) = submap.covariance(column, row) = number();
    requireEndOfLine(expected);
  }
}

namespace {

/** The ids that features have in text. */
class TextIds {
 public:
  explicit TextIds(const LandmarkSubmaps& submaps) {
    for (const auto& submap : submaps) {
      known_ = known_ && submap->ids_known;
      for (const auto& feature : submap->features) raise_ = raise_ || feature.id == 0;
    }
  }

  /** To be called once for each feature, in their order. */
  uint32_t next(const SubmapFeature& feature) { return known_ ? feature.id + (raise_ ? 1 : 0) : ++last_; }

 private:
  bool known_ = true, raise_ = false;
  uint32_t last_ = 0;
};

}  // namespace

std::string landmarkText(const LandmarkSubmaps& submaps) {
  TextIds ids(submaps);
  std::string text;
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    const LandmarkSubmap& submap = *submaps[k];
    const auto& end = submap.end_pose;
    text += fmt::format("MAP {} {}\n0 {}\n0 {}\n0 {}\n", k + 1, submap.dimension(), end.x, end.y, end.phi);
    for (const auto& f : submap.features) {
      const uint32_t id = ids.next(f);
      text += fmt::format("{} {}\n{} {}\n", id, f.x, id, f.y);
    }
    for (std::size_t row = 0; row < submap.dimension(); ++row)
      for (std::size_t column = 0; column <= row; ++column)
        text += fmt::format("{}{}", submap.covariance(row, column), column == row ? "\n" : " ");
  }
  return text;
}

}  // namespace submap_slam
