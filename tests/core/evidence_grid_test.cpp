#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/evidence_grid.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include <utility>

namespace submap_slam {
namespace {

void observe(EvidenceGrid& grid, double x, double y, float log_odds, float hits) {
  *grid.log_odds.cellByPos(x, y) = log_odds;
  *grid.hits.cellByPos(x, y) = hits;
}

/** 2 m × 1 m with 0.1 m cells, three of them observed. */
EvidenceGrid sampleGrid() {
  EvidenceGrid grid(-1, 1, 0, 1, 0.1);
  observe(grid, -0.35, 0.25, 2.5f, 3);
  observe(grid, 0.45, 0.25, -1.25f, 2);
  observe(grid, 0.05, 0.65, 0.5f, 0.25f);
  return grid;
}

EvidenceGrid readBack(const EvidenceGrid& grid) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  grid.writeTo(archive);
  stream.Seek(0);
  return EvidenceGrid::readFrom(archive);
}

/** What readFrom makes of a header without cells. */
void readHeader(double x_min, double y_min, double resolution, uint32_t nx, uint32_t ny) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << x_min << y_min << resolution << nx << ny;
  stream.Seek(0);
  EvidenceGrid::readFrom(archive);
}

TEST(EvidenceGrid, StartsUnknown) {
  EXPECT_EQ(EvidenceGrid().observedCells(), 0u);
  const EvidenceGrid grid(-1, 1, 0, 1, 0.1);
  EXPECT_EQ(grid.sizeX(), 20u);
  EXPECT_EQ(grid.sizeY(), 10u);
  EXPECT_EQ(grid.cells(), 200u);
  EXPECT_EQ(grid.observedCells(), 0u);
}

TEST(EvidenceGrid, LimitsAreRoundedOutwards) {
  const EvidenceGrid grid(-0.93, 0.27, 0.01, 0.09, 0.1);
  EXPECT_NEAR(grid.hits.getXMin(), -1.0, 1e-9);
  EXPECT_NEAR(grid.hits.getXMax(), 0.3, 1e-9);
  EXPECT_NEAR(grid.hits.getYMin(), 0.0, 1e-9);
  EXPECT_NEAR(grid.hits.getYMax(), 0.1, 1e-9);
}

TEST(EvidenceGrid, CroppingKeepsEveryObservedCellInPlace) {
  const EvidenceGrid cropped = sampleGrid().cropped();
  EXPECT_EQ(cropped.sizeX(), 9u);  // −0.4 … 0.5
  EXPECT_EQ(cropped.sizeY(), 5u);  // 0.2 … 0.7
  EXPECT_NEAR(cropped.hits.getXMin(), -0.4, 1e-9);
  EXPECT_NEAR(cropped.hits.getYMin(), 0.2, 1e-9);
  EXPECT_EQ(cropped.observedCells(), 3u);
  EXPECT_EQ(*cropped.log_odds.cellByPos(-0.35, 0.25), 2.5f);
  EXPECT_EQ(*cropped.log_odds.cellByPos(0.45, 0.25), -1.25f);
  EXPECT_EQ(*cropped.hits.cellByPos(0.05, 0.65), 0.25f);
}

TEST(EvidenceGrid, CroppingIsIdempotentAndNothingIsLeftOfNothing) {
  const EvidenceGrid once = sampleGrid().cropped(), twice = once.cropped();
  EXPECT_EQ(twice.cells(), once.cells());
  EXPECT_EQ(twice.log_odds.data(), once.log_odds.data());
  EXPECT_EQ(EvidenceGrid(-5, 5, -5, 5, 0.1).cropped().observedCells(), 0u);
}

TEST(EvidenceGrid, OccupancyIsTheLogisticOfTheEvidence) {
  EXPECT_NEAR(occupancyOf(static_cast<float>(std::log(3.0))), 0.75, 1e-6);
  EXPECT_DOUBLE_EQ(occupancyOf(0), 0.5);
}

TEST(EvidenceGrid, ReadsBackTheSameBits) {
  const EvidenceGrid grid = sampleGrid(), back = readBack(grid);
  EXPECT_EQ(back.sizeX(), grid.sizeX());
  EXPECT_EQ(back.resolution(), grid.resolution());
  EXPECT_EQ(back.hits.getXMin(), grid.hits.getXMin());
  EXPECT_EQ(back.log_odds.data(), grid.log_odds.data());
  EXPECT_EQ(back.hits.data(), grid.hits.data());
}

TEST(EvidenceGrid, ReadsBackOddLattices) {
  for (const double resolution : {0.05, 0.03, 0.1, 1.0 / 3}) {
    EvidenceGrid grid(-17.31, 3.77, 100.01, 129.99, resolution);
    observe(grid, -3.312, 110.017, 1, 1);
    const EvidenceGrid cropped = grid.cropped(), back = readBack(cropped), whole = readBack(grid);
    EXPECT_EQ(back.cells(), 1u) << resolution;
    EXPECT_EQ(*back.hits.cellByPos(-3.312, 110.017), 1) << resolution;
    EXPECT_EQ(whole.hits.data(), grid.hits.data()) << resolution;
  }
}

TEST(EvidenceGrid, RefusesImplausibleSizes) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(readHeader(0, 0, 0, 2, 2), std::runtime_error);
  EXPECT_THROW(readHeader(0, 0, -0.1, 2, 2), std::runtime_error);
  EXPECT_THROW(readHeader(0, 0, kNan, 2, 2), std::runtime_error);
  EXPECT_THROW(readHeader(kNan, 0, 0.1, 2, 2), std::runtime_error);
  EXPECT_THROW(readHeader(0, kNan, 0.1, 2, 2), std::runtime_error);
  EXPECT_THROW(readHeader(0, 0, 0.1, 0, 2), std::runtime_error);
  EXPECT_THROW(readHeader(0, 0, 0.1, 2, 0xffffffffu), std::runtime_error);
  EXPECT_ANY_THROW(readHeader(0, 0, 0.1, 2, 2)) << "cells are missing";
}

TEST(EvidenceGrid, IsMovedWithoutACopy) {
  EvidenceGrid grid(-1, 2, -1, 1, 0.1);
  *grid.hits.cellByPos(1.25, -0.35) = 2;
  const float* cells = grid.hits.data().data();
  EvidenceGrid constructed = std::move(grid);
  EXPECT_EQ(constructed.hits.data().data(), cells);
  EvidenceGrid assigned(0, 5, 0, 5, 1);
  assigned = std::move(constructed);
  EXPECT_EQ(assigned.hits.data().data(), cells);
  EXPECT_EQ(assigned.sizeX(), 30u);
  EXPECT_EQ(*assigned.hits.cellByPos(1.25, -0.35), 2);
}

}  // namespace
}  // namespace submap_slam
