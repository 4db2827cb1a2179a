#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/packed_evidence.h>
#include <submap_slam/mapping/laser_points.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace submap_slam {

struct AgreementParams {
  double tolerance = 0.15;  ///< m, a surface this near to an occupied cell is a hit
  double free_hits = 2;     ///< observations that a cell needs to count as free
};

/** What agreementOf asks of the evidence of a submap, two bits for each cell: a few hundredths of its memory,
 * so that those of all submaps can be kept. Frame: local map frame. */
class AgreementMap {
 public:
  enum class Finding { kHit, kFree, kUnknown };

  explicit AgreementMap(const PackedEvidence& evidence, const AgreementParams& params = {});

  /** What is around a point (m): something occupied within the tolerance, only free space, or too little to
   * say. */
  Finding at(double x, double y) const;

 private:
  static constexpr int kShift = 3, kSide = 1 << kShift, kMask = kSide - 1;

  /** Bit 8·row + column of a block of 8 × 8 cells. */
  struct Block {
    uint64_t occupied = 0, free = 0;
  };
  Block& writableBlock(int bx, int by);
  Block blockAt(int bx, int by) const {
    if (bx < 0 || bx >= columns_ || by < 0 || by >= rows_) return {};
    return blocks_[numbers_[indexOf(bx, by)]];
  }
  std::size_t indexOf(int bx, int by) const {
    return static_cast<std::size_t>(by) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(bx);
  }
  bool isOccupiedWithin(int left, int right, int low, int high) const;

  double x_min_, y_min_, resolution_;
  int reach_;                      // cells
  int columns_, rows_;             // of blocks
  std::vector<uint32_t> numbers_;  // index into blocks_ of each block, row by row
  std::vector<Block> blocks_;      // the first one is empty
};

/** How surfaces of one submap fare in the map of another. */
struct MapAgreement {
  double hit_share = 0;  ///< share of all points that fall on occupied cells

  /** hits / (hits + points in free space): what they say where both have seen something; 1 if nowhere. */
  double agreement = 1;
};

/** @param T_map_points pose of the points' frame in the map's local map frame */
MapAgreement agreementOf(const LaserPoints& points, const AgreementMap& map,
                         const mrpt::math::TPose2D& T_map_points);

}  // namespace submap_slam
