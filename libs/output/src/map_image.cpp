#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <submap_slam/output/map_image.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "binary_file.h"
#include "drawing.h"

namespace submap_slam {
namespace {

using mrpt::img::CImage;
using mrpt::img::TColor;

/** Where things are in the picture. */
struct Layout {
  int px_per_cell = 1, cells_per_px = 1;  // one of them is 1
  int map_width = 0, map_height = 0;      // px
  double px_per_m = 1, x_min = 0, y_max = 0;

  Layout(const EvidenceGrid& map, int max_side) {
    constexpr int kPleasant_px = 1600, kMaxPxPerCell = 8;
    const int nx = static_cast<int>(map.sizeX()), ny = static_cast<int>(map.sizeY());
    const int longest = std::max(nx, ny), available = max_side - 2 * kMargin_px - kFooter_px;
    cells_per_px = (longest + available - 1) / available;
    px_per_cell = std::clamp(std::min(kPleasant_px, available) / longest, 1, kMaxPxPerCell);
    map_width = (nx * px_per_cell + cells_per_px - 1) / cells_per_px;
    map_height = (ny * px_per_cell + cells_per_px - 1) / cells_per_px;
    px_per_m = px_per_cell / (cells_per_px * map.resolution());
    x_min = map.log_odds.getXMin();
    y_max = map.log_odds.getYMax();
  }

  int imageWidth() const { return std::max(map_width + 2 * kMargin_px, 160); }
  int imageHeight() const { return map_height + 2 * kMargin_px + kFooter_px; }

  Pixel at(double x, double y) const {
    return {kMargin_px + (x - x_min) * px_per_m - 0.5, kMargin_px + (y_max - y) * px_per_m - 0.5};
  }

  /** Half the width of thin lines. */
  double strokeRadius_px() const { return std::max(0.8, std::max(map_width, map_height) / 1600.0); }
};

/** Colour of the most occupied of the observed cells that share a pixel. */
TColor cellColor(const EvidenceGrid& map, std::size_t cx, std::size_t cy, std::size_t block) {
  double occupancy = -1;
  for (std::size_t y = cy; y < std::min(cy + block, map.sizeY()); ++y)
    for (std::size_t x = cx; x < std::min(cx + block, map.sizeX()); ++x)
      if (*map.hits.cellByIndex(static_cast<unsigned>(x), static_cast<unsigned>(y)) > 0)
        occupancy = std::max(occupancy, map.occupancy(x, y));
  if (occupancy < 0) return kBackground;
  // Steeper in the middle, so that weak evidence already looks like what it says.
  const double darkness = occupancy * occupancy * (3 - 2 * occupancy);
  return mix(TColor(255, 255, 255), TColor(24, 26, 32), darkness);
}

void drawMap(CImage& image, const EvidenceGrid& map, const Layout& layout) {
  const auto block = static_cast<std::size_t>(layout.cells_per_px);
  const int bottom = kMargin_px + layout.map_height - 1, size = layout.px_per_cell;
  for (std::size_t cy = 0, row = 0; cy < map.sizeY(); cy += block, ++row)
    for (std::size_t cx = 0, column = 0; cx < map.sizeX(); cx += block, ++column) {
      const TColor color = cellColor(map, cx, cy, block);
      const int left = kMargin_px + static_cast<int>(column) * size,
                low = bottom - static_cast<int>(row) * size;
      for (int v = low - size + 1; v <= low; ++v)
        for (int u = left; u < left + size; ++u) image.setPixel(u, v, color);
    }
}

std::vector<PathPoint> pathOf(const Trajectory& trajectory, const Layout& layout) {
  std::vector<PathPoint> path;
  if (trajectory.empty()) return path;
  const auto seconds = [](const StampedPose& p) { return mrpt::Clock::toDouble(p.stamp); };
  const double start = seconds(trajectory.front()), duration = seconds(trajectory.back()) - start;
  for (const auto& p : trajectory)
    path.push_back({layout.at(p.pose.x, p.pose.y), duration > 0 ? (seconds(p) - start) / duration : 0});
  return path;
}

void drawFrames(CImage& image, const std::vector<mrpt::poses::CPosePDFGaussian>& frames,
                const Layout& layout) {
  const double radius = 2.5 * layout.strokeRadius_px();
  for (const auto& frame : frames) {
    const Pixel p = layout.at(frame.mean.x(), frame.mean.y());
    drawStroke(image, p, p, radius + 1, TColor(255, 255, 255));
    drawStroke(image, p, p, radius, TColor(20, 130, 70));
  }
}

}  // namespace

void writeMapImage(const std::string& file, const EvidenceGrid& map, const Trajectory& trajectory,
                   const std::vector<mrpt::poses::CPosePDFGaussian>& frames, int max_side) {
  constexpr int kMinSide = 200;
  if (max_side < kMinSide) throw std::invalid_argument("writeMapImage: max_side must be at least 200 pixels");
  std::optional<EvidenceGrid> smaller;  // a second copy of a large map is made only where it is needed
  if (!map.isCropped()) smaller = map.cropped();
  const EvidenceGrid& observed = smaller ? *smaller : map;
  const Layout layout(observed, max_side);
  CImage image(static_cast<unsigned>(layout.imageWidth()), static_cast<unsigned>(layout.imageHeight()),
               mrpt::img::CH_RGB);
  image.filledRectangle(0, 0, layout.imageWidth() - 1, layout.imageHeight() - 1, kBackground);
  drawMap(image, observed, layout);
  drawPath(image, pathOf(trajectory, layout), layout.strokeRadius_px());
  drawFrames(image, frames, layout);
  drawScaleBar(image, layout.px_per_m);
  writeBytes(file, png(image));
}

}  // namespace submap_slam
