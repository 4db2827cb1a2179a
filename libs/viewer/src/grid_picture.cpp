#include <submap_slam/viewer/grid_picture.h>

#include <mrpt/img/CImage.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::img::CImage;
using mrpt::img::TColor;

constexpr double kFreeOpacity = 0.55;
constexpr double kFreeGrey = 255;

/** Log-odds of the most occupied cell in each pixel; row 0 is the lowest. */
struct Raster {
  int columns = 0, rows = 0, cells = 1;  // cells a pixel has a side
  std::vector<float> log_odds;
  std::vector<char> known;
};

Raster rasterOf(const PackedEvidence& evidence) {
  Raster raster;
  const int longest = std::max(evidence.sizeX(), evidence.sizeY());
  raster.cells = std::max(1, (longest + kLargestPicture - 1) / kLargestPicture);
  raster.columns = (evidence.sizeX() + raster.cells - 1) / raster.cells;
  raster.rows = (evidence.sizeY() + raster.cells - 1) / raster.cells;
  const auto pixels = static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows);
  raster.log_odds.assign(pixels, 0);
  raster.known.assign(pixels, 0);
  evidence.forEachObserved([&raster](int cx, int cy, float log_odds, float) {
    const auto k = static_cast<std::size_t>(cy / raster.cells * raster.columns + cx / raster.cells);
    raster.log_odds[k] = raster.known[k] ? std::max(raster.log_odds[k], log_odds) : log_odds;
    raster.known[k] = 1;
  });
  return raster;
}

uint8_t mixed(double at_0, double at_1, double share) {
  return static_cast<uint8_t>(std::lround(at_0 + (at_1 - at_0) * share));
}

}  // namespace

mrpt::opengl::CTexturedPlane::Ptr gridPicture(const PackedEvidence& evidence, const TColor& occupied) {
  const Raster raster = rasterOf(evidence);
  const auto width = static_cast<unsigned>(raster.columns), height = static_cast<unsigned>(raster.rows);
  CImage colours(width, height, mrpt::img::CH_RGB);
  CImage opacity(width, height, mrpt::img::CH_GRAY);
  for (int row = 0; row < raster.rows; ++row)
    for (int column = 0; column < raster.columns; ++column) {
      const auto k = static_cast<std::size_t>(row * raster.columns + column);
      const double p = 1 / (1 + std::exp(-static_cast<double>(raster.log_odds[k])));
      const double wall = std::clamp((p - 0.5) * 2, 0.0, 1.0);
      const double opaque = raster.known[k] ? std::max(wall, kFreeOpacity * std::abs(p - 0.5) * 2) : 0;
      uint8_t* const pixel = colours.ptr<uint8_t>(static_cast<unsigned>(column), static_cast<unsigned>(row));
      pixel[0] = mixed(kFreeGrey, occupied.B, wall);
      pixel[1] = mixed(kFreeGrey, occupied.G, wall);
      pixel[2] = mixed(kFreeGrey, occupied.R, wall);
      *opacity.ptr<uint8_t>(static_cast<unsigned>(column), static_cast<unsigned>(row)) =
          mixed(0, 255, opaque);
    }
  auto plane = mrpt::opengl::CTexturedPlane::Create();
  const double pixel_m = raster.cells * evidence.resolution();
  const double x = evidence.xMin(), y = evidence.yMin();
  plane->setPlaneCorners(static_cast<float>(x), static_cast<float>(x + raster.columns * pixel_m),
                         static_cast<float>(y), static_cast<float>(y + raster.rows * pixel_m));
  plane->assignImage(colours, opacity);
  plane->CRenderizableShaderTexturedTriangles::enableLight(false);
  return plane;
}

}  // namespace submap_slam
