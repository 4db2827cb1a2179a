#include "drawing.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace submap_slam {

using mrpt::img::CImage;
using mrpt::img::TColor;

namespace {

double distance(const Pixel& a, const Pixel& b) { return std::hypot(a.u - b.u, a.v - b.v); }

struct PixelRange {
  int first, last;
};

/** Pixels of one axis of the picture within reach of the interval between two coordinates. */
PixelRange covered(double a, double b, double reach, std::size_t size) {
  const double end = static_cast<double>(size);
  return {static_cast<int>(std::clamp(std::min(a, b) - reach, 0.0, end)),
          static_cast<int>(std::clamp(std::max(a, b) + reach, -1.0, end - 1))};
}

/** The longest of 1, 2, 5, 10, … that is not above the limit. */
double roundLength(double limit_m) {
  const double power = std::pow(10.0, std::floor(std::log10(limit_m)));
  const double digit = limit_m / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

}  // namespace

TColor mix(const TColor& a, const TColor& b, double share_of_b) {
  const auto channel = [&](uint8_t from, uint8_t to) {
    return static_cast<uint8_t>(std::lround(from + share_of_b * (to - from)));
  };
  return {channel(a.R, b.R), channel(a.G, b.G), channel(a.B, b.B)};
}

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

void drawPath(CImage& image, const std::vector<PathPoint>& path, double radius_px) {
  if (path.empty()) return;
  Pixel from = path.front().at;
  for (const auto& [to, share] : path) {
    // Shorter steps would cover the same edge pixels again and again.
    if (distance(from, to) < 1) continue;
    drawStroke(image, from, to, radius_px,
               mix(TColor(20, 90, 235), TColor(230, 40, 40), std::clamp(share, 0.0, 1.0)));
    from = to;
  }
}

void drawScaleBar(CImage& image, double px_per_m) {
  constexpr double kShareOfWidth = 0.3;
  const TColor color(60, 60, 60);
  const double length_m = roundLength(kShareOfWidth * static_cast<double>(image.getWidth()) / px_per_m);
  const int v = static_cast<int>(image.getHeight()) - kFooter_px / 2 - 5;
  const Pixel left{kMargin_px, static_cast<double>(v)}, right{kMargin_px + length_m * px_per_m, left.v};
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

}  // namespace submap_slam
