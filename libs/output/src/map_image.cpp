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
  CellRange cells;                        // that are shown
  int px_per_cell = 1, cells_per_px = 1;  // one of them is 1
  int map_width = 0, map_height = 0;      // px
  double px_per_m = 1, x_min = 0, y_max = 0;

  /** Of the observed cells of a map, or of all if there are none. */
  Layout(const PackedEvidence& map, int max_side) : cells(map.observedRange()) {
    constexpr int kPleasant_px = 1600, kMaxPxPerCell = 8;
    if (cells.empty()) cells = {0, map.sizeX() - 1, 0, map.sizeY() - 1};
    const int nx = cells.columns(), ny = cells.rows();
    const int longest = std::max(nx, ny), available = max_side - 2 * kMargin_px - kFooter_px;
    cells_per_px = (longest + available - 1) / available;
    px_per_cell = std::clamp(std::min(kPleasant_px, available) / longest, 1, kMaxPxPerCell);
    map_width = (nx * px_per_cell + cells_per_px - 1) / cells_per_px;
    map_height = (ny * px_per_cell + cells_per_px - 1) / cells_per_px;
    px_per_m = px_per_cell / (cells_per_px * map.resolution());
    x_min = map.xMin() + cells.x_first * map.resolution();
    y_max = map.yMax() - (map.sizeY() - 1 - cells.y_last) * map.resolution();
  }

  int imageWidth() const { return std::max(map_width + 2 * kMargin_px, 160); }
  int imageHeight() const { return map_height + 2 * kMargin_px + kFooter_px; }

  Pixel at(double x, double y) const {
    return {kMargin_px + (x - x_min) * px_per_m - 0.5, kMargin_px + (y_max - y) * px_per_m - 0.5};
  }

  /** Half the width of thin lines. */
  double strokeRadius_px() const { return std::max(0.8, std::max(map_width, map_height) / 1600.0); }
};

/** The largest log-odds of the observed cells in a square; nothing if there are none. */
std::optional<float> mostOccupied(const PackedEvidence& map, int cx, int cy, int side) {
  std::optional<float> most;
  for (int y = cy; y < cy + side; ++y)
    for (int x = cx; x < cx + side; ++x) {
      const auto [log_odds, hits] = map.cell(x, y);
      if (hits > 0) most = std::max(most.value_or(log_odds), log_odds);
    }
  return most;
}

TColor cellColor(float log_odds) {
  const double occupancy = occupancyOf(log_odds);
  // Steeper in the middle, so that weak evidence already looks like what it says.
  const double darkness = occupancy * occupancy * (3 - 2 * occupancy);
  return mix(TColor(255, 255, 255), TColor(24, 26, 32), darkness);
}

/** Of the observed cells that share a pixel the most occupied one shows. */
void drawMap(CImage& image, const PackedEvidence& map, const Layout& layout) {
  const int bottom = kMargin_px + layout.map_height - 1, size = layout.px_per_cell,
            block = layout.cells_per_px;
  for (int cy = layout.cells.y_first, low = bottom; cy <= layout.cells.y_last; cy += block, low -= size)
    for (int cx = layout.cells.x_first, left = kMargin_px; cx <= layout.cells.x_last;
         cx += block, left += size) {
      const auto log_odds = mostOccupied(map, cx, cy, block);
      if (!log_odds) continue;
      const TColor color = cellColor(*log_odds);
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

void writeMapImage(const std::string& file, const PackedEvidence& map, const Trajectory& trajectory,
                   const std::vector<mrpt::poses::CPosePDFGaussian>& frames, int max_side) {
  constexpr int kMinSide = 200;
  if (max_side < kMinSide) throw std::invalid_argument("writeMapImage: max_side must be at least 200 pixels");
  const Layout layout(map, max_side);
  CImage image(static_cast<unsigned>(layout.imageWidth()), static_cast<unsigned>(layout.imageHeight()),
               mrpt::img::CH_RGB);
  image.filledRectangle(0, 0, layout.imageWidth() - 1, layout.imageHeight() - 1, kBackground);
  drawMap(image, map, layout);
  drawPath(image, pathOf(trajectory, layout), layout.strokeRadius_px());
  drawFrames(image, frames, layout);
  drawScaleBar(image, layout.px_per_m);
  writeBytes(file, png(image));
}

}  // namespace submap_slam
