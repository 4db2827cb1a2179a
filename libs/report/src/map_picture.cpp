#include <png.h>
#include <submap_slam/report/map_picture.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base64.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** Shade of a log-odds, positive = occupied, without an exponential for each cell. */
class Shades {
 public:
  Shades() {
    for (int i = 0; i < kSteps; ++i) {
      const double log_odds = (i - kMiddle) / kPerUnit, p = 1 / (1 + std::exp(-log_odds));
      const double darkness = p * p * (3 - 2 * p);  // steeper in the middle: weak evidence shows too
      shade_[static_cast<std::size_t>(i)] = static_cast<uint8_t>(
          MapPicture::kFree + std::lround(darkness * (MapPicture::kOccupied - MapPicture::kFree)));
    }
  }

  uint8_t of(double log_odds) const {
    const double step = std::clamp(log_odds * kPerUnit + kMiddle, 0.0, kSteps - 1.0);
    return shade_[static_cast<std::size_t>(step)];
  }

 private:
  static constexpr int kSteps = 512, kMiddle = kSteps / 2;
  static constexpr double kPerUnit = 32;  // log-odds of -8 … 8
  std::array<uint8_t, kSteps> shade_{};
};

/** Smallest whole number of cells per pixel with which `cells` fit into `max_side` pixels. */
int cellsPerPixel(int cells, int max_side) { return std::max(1, (cells + max_side - 1) / max_side); }

/** An empty picture over a rectangle (m). */
MapPicture emptyPicture(double x_min, double x_max, double y_min, double y_max, double m_per_px) {
  constexpr double kRounding = 1e-6;  // so that whole numbers of pixels stay what they are
  const auto pixels = [&](double length) {
    return std::max(1, static_cast<int>(std::ceil(length / m_per_px - kRounding)));
  };
  MapPicture picture{pixels(x_max - x_min), pixels(y_max - y_min), x_min, y_min, m_per_px, {}};
  picture.shades.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
                        MapPicture::kUnknown);
  return picture;
}

/** The four corners of a map in another frame. */
std::array<TPoint2D, 4> cornersOf(const mrpt::maps::COccupancyGridMap2D& map, const TPose2D& T_ref_w) {
  return {T_ref_w.composePoint({map.getXMin(), map.getYMin()}),
          T_ref_w.composePoint({map.getXMax(), map.getYMin()}),
          T_ref_w.composePoint({map.getXMin(), map.getYMax()}),
          T_ref_w.composePoint({map.getXMax(), map.getYMax()})};
}

std::string png(const MapPicture& picture) {
  constexpr int kShades = MapPicture::kOccupied + 1;
  std::array<png_byte, 4 * kShades> colors{};  // RGBA; the first one is transparent
  for (int shade = MapPicture::kFree; shade < kShades; ++shade) {
    constexpr int kDarkest = 16;
    const int grey = 255 - (255 - kDarkest) * (shade - MapPicture::kFree) / (kShades - 1 - MapPicture::kFree);
    std::fill_n(colors.begin() + 4 * shade, 3, static_cast<png_byte>(grey));
    colors[static_cast<std::size_t>(4 * shade + 3)] = 255;
  }
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(picture.width);
  header.height = static_cast<png_uint_32>(picture.height);
  header.format = PNG_FORMAT_RGBA_COLORMAP;
  header.colormap_entries = kShades;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, picture.shades.data(), picture.width,
                                colors.data()) == 0)
    throw std::runtime_error(std::string("PNG: ") + header.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

MapPicture mapPicture(const PackedEvidence& map, int max_side) {
  const CellRange range = map.observedRange();
  if (range.empty()) return emptyPicture(0, 1, 0, 1, 1);
  const Shades shades;
  const int block = cellsPerPixel(std::max(range.columns(), range.rows()), max_side);
  const double r = map.resolution(), x_min = map.xMin() + range.x_first * r,
               y_min = map.yMin() + range.y_first * r;
  MapPicture picture =
      emptyPicture(x_min, x_min + range.columns() * r, y_min, y_min + range.rows() * r, block * r);
  map.forEachObserved([&](int cx, int cy, float log_odds, float) {
    const int column = (cx - range.x_first) / block, row = picture.height - 1 - (cy - range.y_first) / block;
    uint8_t& shade = picture.shades[static_cast<std::size_t>(row * picture.width + column)];
    shade = std::max(shade, shades.of(static_cast<double>(log_odds)));
  });
  return picture;
}

MapPicture mapPicture(const mrpt::maps::COccupancyGridMap2D& map, const TPose2D& T_ref_w, int max_side) {
  const Shades shades;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  TPoint2D low(kInfinity, kInfinity), high(-kInfinity, -kInfinity);
  for (const TPoint2D& corner : cornersOf(map, T_ref_w)) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
  }
  const double r = static_cast<double>(map.getResolution());
  const int cells = static_cast<int>(std::max(high.x - low.x, high.y - low.y) / r);
  const double m_per_px = r * cellsPerPixel(cells, max_side);
  MapPicture picture = emptyPicture(low.x, high.x, low.y, high.y, m_per_px);
  constexpr double kCellsPerUnit = 16;  // MRPT's cells: log-odds of free space in sixteenths
  auto* shade = picture.shades.data();
  for (int v = 0; v < picture.height; ++v)
    for (int u = 0; u < picture.width; ++u, ++shade) {
      const TPoint2D p = T_ref_w.inverseComposePoint(
          {picture.x_min + (u + 0.5) * m_per_px, picture.yMax() - (v + 0.5) * m_per_px});
      const int cx = map.x2idx(static_cast<float>(p.x)), cy = map.y2idx(static_cast<float>(p.y));
      if (cx < 0 || cy < 0 || cx >= static_cast<int>(map.getSizeX()) ||
          cy >= static_cast<int>(map.getSizeY()))
        continue;
      const auto cell = static_cast<double>(map.getRow(cy)[cx]);
      if (cell != 0) *shade = shades.of(-cell / kCellsPerUnit);
    }
  return picture;
}

std::string pngDataUri(const MapPicture& picture) { return "data:image/png;base64," + base64(png(picture)); }

}  // namespace submap_slam
