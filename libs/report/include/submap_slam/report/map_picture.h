#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/packed_evidence.h>

#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

/** A map in few shades, and where it lies. */
struct MapPicture {
  static constexpr uint8_t kUnknown = 0, kFree = 1, kOccupied = 15;

  int width = 0, height = 0;    ///< pixels
  double x_min = 0, y_min = 0;  ///< lower left corner in the frame that it is drawn in (m)
  double m_per_px = 1;          ///< size of a pixel (m)
  std::vector<uint8_t> shades;  ///< row by row from the top (largest y): kUnknown, or kFree … kOccupied

  double xMax() const { return x_min + width * m_per_px; }
  double yMax() const { return y_min + height * m_per_px; }
};

/** The observed part of a map. Where it is too large for `max_side` pixels several cells share a pixel, and
 * the most occupied one is shown. */
MapPicture mapPicture(const PackedEvidence& map, int max_side);

/** A map turned and moved into another frame, each pixel the cell under its centre; cells of probability ½
 * count as unknown.
 * @param T_ref_w pose of the map's frame in the frame of the picture */
MapPicture mapPicture(const mrpt::maps::COccupancyGridMap2D& map, const mrpt::math::TPose2D& T_ref_w,
                      int max_side);

/** The picture as PNG in a data URI: unknown transparent, free white, occupied nearly black. */
std::string pngDataUri(const MapPicture& picture);

}  // namespace submap_slam
