#include <fmt/format.h>
#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <png.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/map_image.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "binary_file.h"

namespace submap_slam {
namespace {

using mrpt::img::CImage;
using mrpt::img::TColor;

constexpr int kMargin_px = 20, kFooter_px = 40;
constexpr TColor kBackground(222, 224, 227);

struct Pixel {
  double u = 0, v = 0;  // right and down; whole numbers are pixel centres
};

double distance(const Pixel& a, const Pixel& b) { return std::hypot(a.u - b.u, a.v - b.v); }

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

TColor mix(const TColor& a, const TColor& b, double share_of_b) {
  const auto channel = [&](uint8_t from, uint8_t to) {
    return static_cast<uint8_t>(std::lround(from + share_of_b * (to - from)));
  };
  return {channel(a.R, b.R), channel(a.G, b.G), channel(a.B, b.B)};
}

struct PixelRange {
  int first, last;
};

/** Pixels of one axis of the picture within reach of the interval between two coordinates. */
PixelRange covered(double a, double b, double reach, std::size_t size) {
  const double end = static_cast<double>(size);
  return {static_cast<int>(std::clamp(std::min(a, b) - reach, 0.0, end)),
          static_cast<int>(std::clamp(std::max(a, b) + reach, -1.0, end - 1))};
}

/** Draws a line with round ends (a disc if both ends are the same), anti-aliased: a pixel is covered as far
 * as its centre lies inside of the edge. */
void drawStroke(CImage& image, const Pixel& a, const Pixel& b, double radius_px, const TColor& color) {
  const double reach = radius_px + 1, du = b.u - a.u, dv = b.v - a.v, length2 = du * du + dv * dv;
  const PixelRange columns = covered(a.u, b.u, reach, image.getWidth());
  const PixelRange rows = covered(a.v, b.v, reach, image.getHeight());
  for (int v = rows.first; v <= rows.last; ++v)
    for (int u = columns.first; u <= columns.last; ++u) {
      const double along =
          length2 > 0 ? std::clamp(((u - a.u) * du + (v - a.v) * dv) / length2, 0.0, 1.0) : 0;
      const double d = std::hypot(u - a.u - along * du, v - a.v - along * dv);
      const double cover = std::clamp(radius_px + 0.5 - d, 0.0, 1.0);
      if (cover <= 0) continue;
      auto* bgr = image.ptr<uint8_t>(static_cast<unsigned>(u), static_cast<unsigned>(v));
      const TColor mixed = mix(TColor(bgr[2], bgr[1], bgr[0]), color, cover);
      bgr[0] = mixed.B, bgr[1] = mixed.G, bgr[2] = mixed.R;
    }
}

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

void drawTrajectory(CImage& image, const Trajectory& trajectory, const Layout& layout) {
  if (trajectory.empty()) return;
  const auto seconds = [](const StampedPose& p) { return mrpt::Clock::toDouble(p.stamp); };
  const double start = seconds(trajectory.front()), duration = seconds(trajectory.back()) - start;
  Pixel from = layout.at(trajectory.front().pose.x, trajectory.front().pose.y);
  for (const auto& p : trajectory) {
    const Pixel to = layout.at(p.pose.x, p.pose.y);
    // Shorter steps would cover the same edge pixels again and again.
    if (distance(from, to) < 1) continue;
    const double share = duration > 0 ? std::clamp((seconds(p) - start) / duration, 0.0, 1.0) : 0;
    drawStroke(image, from, to, layout.strokeRadius_px(),
               mix(TColor(20, 90, 235), TColor(230, 40, 40), share));
    from = to;
  }
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

/** The longest of 1, 2, 5, 10, … that is not above the limit. */
double roundLength(double limit_m) {
  const double power = std::pow(10.0, std::floor(std::log10(limit_m)));
  const double digit = limit_m / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

void drawScaleBar(CImage& image, const Layout& layout) {
  constexpr double kShareOfWidth = 0.3;
  const TColor color(60, 60, 60);
  const double length_m = roundLength(kShareOfWidth * layout.imageWidth() / layout.px_per_m);
  const int v = layout.imageHeight() - kFooter_px / 2 - 5;
  const Pixel left{kMargin_px, static_cast<double>(v)},
      right{kMargin_px + length_m * layout.px_per_m, left.v};
  drawStroke(image, left, right, 1, color);
  for (const Pixel& end : {left, right}) drawStroke(image, {end.u, end.v - 5}, {end.u, end.v + 5}, 1, color);
  image.selectTextFont("9x15");
  image.textOut(static_cast<int>(right.u) + 10, v - 7, fmt::format("{:g} m", length_m), color);
}

std::string png(const CImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.getWidth());
  header.height = static_cast<png_uint_32>(image.getHeight());
  header.format = PNG_FORMAT_BGR;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  const std::unique_ptr<char[]> buffer(new char[size]);
  const auto stride = static_cast<png_int_32>(image.getRowStride());
  if (png_image_write_to_memory(&header, buffer.get(), &size, 0, image.ptrLine<uint8_t>(0), stride,
                                nullptr) == 0)
    throw std::runtime_error(std::string("PNG: ") + header.message);
  return {buffer.get(), size};
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
  drawTrajectory(image, trajectory, layout);
  drawFrames(image, frames, layout);
  drawScaleBar(image, layout);
  writeBytes(file, png(image));
}

}  // namespace submap_slam
