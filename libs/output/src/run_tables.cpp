#include <submap_slam/output/run_tables.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <charconv>
#include <cmath>
#include <fstream>

#include "binary_file.h"

namespace submap_slam {
namespace {

/** One line of a table, read from left to right. */
class Row {
 public:
  Row(std::string text, std::string where) : text_(std::move(text)), where_(std::move(where)) {}

  double number() {
    const std::string field = word();
    double value = 0;
    const char* const field_end = field.data() + field.size();
    const auto [end, error] = std::from_chars(field.data(), field_end, value);
    if (error != std::errc() || end != field_end)
      throw InputError(fmt::format("{}: '{}' is not a number", where_, field));
    return value;
  }

  uint32_t id() { return static_cast<uint32_t>(number()); }

  std::string word() {
    if (at_ > text_.size()) throw InputError(where_ + ": has too few columns");
    const std::size_t end = std::min(text_.find(',', at_), text_.size());
    std::string field = text_.substr(at_, end - at_);
    at_ = end + 1;
    return field;
  }

  /** What is left, without the quotes around it. */
  std::string rest() const {
    std::string left = at_ < text_.size() ? text_.substr(at_) : "";
    return left.size() >= 2 ? left.substr(1, left.size() - 2) : "";
  }

 private:
  std::string text_, where_;
  std::size_t at_ = 0;
};

/** Calls take(row) for each line below the heading. */
template <class Take>
void forEachRow(const std::string& file, Take take) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) throw InputError(fmt::format("{}: cannot be read", file));
  for (int number = 2; std::getline(in, line); ++number) {
    Row row(line, fmt::format("{}:{}", file, number));
    take(row);
  }
}

}  // namespace

void writeFrames(const std::string& file, const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  std::string text = "submap,x_m,y_m,phi_rad,xx,xy,xphi,yy,yphi,phiphi\n";
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto& [mean, C] = std::tie(frames[k].mean, frames[k].cov);
    text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", k, mean.x(),
                        mean.y(), mean.phi(), C(0, 0), C(0, 1), C(0, 2), C(1, 1), C(1, 2), C(2, 2));
  }
  writeBytes(file, text);
}

std::vector<mrpt::poses::CPosePDFGaussian> readFrames(const std::string& file) {
  std::vector<mrpt::poses::CPosePDFGaussian> frames;
  forEachRow(file, [&frames](Row& row) {
    row.id();
    mrpt::poses::CPosePDFGaussian frame;
    const double x = row.number(), y = row.number(), phi = row.number();
    frame.mean = mrpt::poses::CPose2D(x, y, phi);
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) frame.cov(i, j) = frame.cov(j, i) = row.number();
    frames.push_back(frame);
  });
  return frames;
}

std::vector<Constraint> readConstraints(const std::string& file) {
  std::vector<Constraint> constraints;
  forEachRow(file, [&constraints](Row& row) {
    Constraint c;
    c.from = row.id();
    c.to = row.id();
    c.inter = row.word() == "inter";
    c.accepted = row.number() != 0;
    const double x = row.number(), y = row.number(), phi = row.number();
    c.T_a_b.mean = mrpt::poses::CPose2D(x, y, phi);
    c.T_a_b.cov.setZero();
    for (int i = 0; i < 3; ++i) c.T_a_b.cov(i, i) = std::pow(row.number(), 2);
    c.reason = row.rest();
    constraints.push_back(c);
  });
  return constraints;
}

}  // namespace submap_slam
