/** What pictures for people are drawn with. */
#pragma once

#include <mrpt/img/CImage.h>

#include <string>
#include <vector>

namespace submap_slam {

constexpr int kMargin_px = 20, kFooter_px = 40;
constexpr mrpt::img::TColor kBackground(222, 224, 227);

struct Pixel {
  double u = 0, v = 0;  ///< right and down; whole numbers are pixel centres
};

mrpt::img::TColor mix(const mrpt::img::TColor& a, const mrpt::img::TColor& b, double share_of_b);

/** Draws a line with round ends (a disc if both ends are the same), anti-aliased: a pixel is covered as far
 * as its centre lies inside of the edge. */
void drawStroke(mrpt::img::CImage& image, const Pixel& a, const Pixel& b, double radius_px,
                const mrpt::img::TColor& color);

/** A point of a path; the share of it that lies behind chooses the colour. */
struct PathPoint {
  Pixel at;
  double share = 0;
};

/** Draws a path, blue at its start, red at its end. */
void drawPath(mrpt::img::CImage& image, const std::vector<PathPoint>& path, double radius_px);

/** Draws a scale bar of a round length into the footer. */
void drawScaleBar(mrpt::img::CImage& image, double px_per_m);

/** The bytes of a PNG file. */
std::string png(const mrpt::img::CImage& image);

}  // namespace submap_slam
