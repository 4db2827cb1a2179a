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

/** Columns and rows of the cells that were observed; first > last if none was. */
struct CellRange {
  std::size_t x_first, x_last = 0, y_first, y_last = 0;
};

CellRange observedRange(const EvidenceGrid& map) {
  CellRange range{map.sizeX(), 0, map.sizeY(), 0};
  const float* hits = map.hits.data().data();
  for (std::size_t y = 0; y < map.sizeY(); ++y)
    for (std::size_t x = 0; x < map.sizeX(); ++x)
      if (hits[y * map.sizeX() + x] > 0) {
        range.x_first = std::min(range.x_first, x), range.x_last = std::max(range.x_last, x);
        range.y_first = std::min(range.y_first, y), range.y_last = std::max(range.y_last, y);
      }
  return range;
}

/** Smallest whole number of cells per pixel with which `cells` fit into `max_side` pixels. */
std::size_t cellsPerPixel(std::size_t cells, int max_side) {
  const auto side = static_cast<std::size_t>(max_side);
  return std::max<std::size_t>(1, (cells + side - 1) / side);
}

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

MapPicture mapPicture(const EvidenceGrid& map, int max_side) {
  const CellRange range = observedRange(map);
  if (range.x_first > range.x_last) return emptyPicture(0, 1, 0, 1, 1);
  const Shades shades;
  const std::size_t nx = range.x_last - range.x_first + 1, ny = range.y_last - range.y_first + 1;
  const std::size_t block = cellsPerPixel(std::max(nx, ny), max_side);
  const double r = map.resolution(), m_per_px = static_cast<double>(block) * r;
  const double x_min = map.log_odds.getXMin() + static_cast<double>(range.x_first) * r;
  const double y_min = map.log_odds.getYMin() + static_cast<double>(range.y_first) * r;
  MapPicture picture = emptyPicture(x_min, x_min + static_cast<double>(nx) * r, y_min,
                                    y_min + static_cast<double>(ny) * r, m_per_px);
  const float *log_odds = map.log_odds.data().data(), *hits = map.hits.data().data();
  for (std::size_t y = 0; y < ny; ++y) {
    const std::size_t first = (range.y_first + y) * map.sizeX() + range.x_first;
    const std::size_t row = static_cast<std::size_t>(picture.height) - 1 - y / block;
    for (std::size_t x = 0; x < nx; ++x) {
      if (!(hits[first + x] > 0)) continue;
      uint8_t& shade = picture.shades[row * static_cast<std::size_t>(picture.width) + x / block];
      shade = std::max(shade, shades.of(static_cast<double>(log_odds[first + x])));
    }
  }
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
  const auto cells = static_cast<std::size_t>(std::max(high.x - low.x, high.y - low.y) / r);
  const double m_per_px = r * static_cast<double>(cellsPerPixel(cells, max_side));
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
