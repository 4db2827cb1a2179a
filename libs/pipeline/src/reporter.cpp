#include <submap_slam/pipeline/reporter.h>

#include <submap_slam/pipeline/printable.h>

namespace submap_slam {

void Reporter::progress(const std::string&, double, std::size_t, const std::string&) {}

void Reporter::note(const std::string&) {}

void Reporter::frames(const std::vector<mrpt::math::TPose2D>&) {}

void Reporter::showWarning(const std::string&) {}

void Reporter::warning(const std::string& line) {
  const std::string text = printable(line);
  showWarning(text);
  log_.push_back("warning: " + text);
  warnings_.push_back(text);
}

}  // namespace submap_slam
