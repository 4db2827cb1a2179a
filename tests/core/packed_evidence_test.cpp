#include <submap_slam/core/packed_evidence.h>

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/joined_map.h>

#include <cmath>
#include <sstream>

namespace submap_slam {
namespace {

/** 3.1 m × 2.3 m with 0.1 m cells, a few of them observed, in opposite corners and across block borders. */
EvidenceGrid sparseGrid() {
  EvidenceGrid grid(-1.2, 1.9, -0.8, 1.5, 0.1);
  const unsigned last_x = static_cast<unsigned>(grid.sizeX()) - 1,
                 last_y = static_cast<unsigned>(grid.sizeY()) - 1;
  float value = 1;
  for (const auto& [x, y] :
       {std::pair(0u, 0u), {7u, 3u}, {8u, 3u}, {8u, 8u}, {last_x, 5u}, {last_x, last_y}}) {
    *grid.log_odds.cellByIndex(x, y) = -0.37f * value;
    *grid.hits.cellByIndex(x, y) = value++;
  }
  return grid;
}

void expectSameGrid(const EvidenceGrid& a, const EvidenceGrid& b) {
  EXPECT_EQ(a.sizeX(), b.sizeX());
  EXPECT_EQ(a.sizeY(), b.sizeY());
  EXPECT_EQ(a.hits.getXMin(), b.hits.getXMin());
  EXPECT_EQ(a.hits.getYMax(), b.hits.getYMax());
  EXPECT_EQ(a.log_odds.data(), b.log_odds.data());
  EXPECT_EQ(a.hits.data(), b.hits.data());
}

std::string archived(const PackedEvidence& evidence) {
  mrpt::io::CMemoryStream stream;
  auto archive = mrpt::serialization::archiveFrom(stream);
  evidence.writeTo(archive);
  return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

GridSubmap::Ptr submapWith(const EvidenceGrid& grid) {
  auto submap = GridSubmap::Create();
  submap->evidence = grid;
  return submap;
}

TEST(PackedEvidence, UnpacksToTheSameGrid) {
  expectSameGrid(PackedEvidence(sparseGrid()).unpacked(), sparseGrid());
  const EvidenceGrid unknown(-1, 1, -1, 1, 0.1);
  EXPECT_TRUE(PackedEvidence(unknown).empty());
  expectSameGrid(PackedEvidence(unknown).unpacked(), unknown);
}

TEST(PackedEvidence, ReadsBackWhatItWrote) {
  for (const EvidenceGrid& grid : {sparseGrid(), EvidenceGrid(-1, 1, -1, 1, 0.1)}) {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    PackedEvidence(grid).writeTo(archive);
    stream.Seek(0);
    expectSameGrid(PackedEvidence::readFrom(archive).unpacked(), grid);
  }
}

TEST(PackedEvidence, RefusesDamagedLimitsAndBlocks) {
  const std::string whole = archived(PackedEvidence(sparseGrid()));
  const auto readDamaged = [&](std::size_t byte) {
    std::string bytes = whole;
    bytes[byte] = static_cast<char>(bytes[byte] ^ 0x40);
    mrpt::io::CMemoryStream damaged;
    damaged.Write(bytes.data(), bytes.size());
    damaged.Seek(0);
    auto in = mrpt::serialization::archiveFrom(damaged);
    PackedEvidence::readFrom(in);
  };
  const std::size_t resolution = 4 * 8 + 7, columns = 5 * 8, blocks = columns + 8, position = blocks + 4;
  for (const std::size_t byte : {resolution, columns, blocks + 2, position, position + 3})
    EXPECT_THROW(readDamaged(byte), std::runtime_error) << byte;
}

TEST(PackedEvidence, VisitsEachObservedCellOnce) {
  const EvidenceGrid grid = sparseGrid();
  std::size_t visits = 0;
  PackedEvidence(grid).forEachObserved([&](int cx, int cy, float log_odds, float hits) {
    ++visits;
    EXPECT_EQ(*grid.log_odds.cellByIndex(static_cast<unsigned>(cx), static_cast<unsigned>(cy)), log_odds);
    EXPECT_EQ(*grid.hits.cellByIndex(static_cast<unsigned>(cx), static_cast<unsigned>(cy)), hits);
  });
  EXPECT_EQ(visits, grid.observedCells());
}

TEST(PackedEvidence, FilledInAnyOrderIsLikeTheGrid) {
  const EvidenceGrid grid = sparseGrid();
  std::vector<std::pair<unsigned, unsigned>> cells;
  for (unsigned y = 0; y < grid.sizeY(); ++y)
    for (unsigned x = 0; x < grid.sizeX(); ++x)
      if (*grid.hits.cellByIndex(x, y) > 0) cells.emplace_back(x, y);
  PackedEvidence filled(-1.2, 1.9, -0.8, 1.5, 0.1);
  for (; !cells.empty(); cells.pop_back()) {
    const auto [x, y] = cells.back();
    filled.set(static_cast<int>(x), static_cast<int>(y), 7, 1);
    filled.set(static_cast<int>(x), static_cast<int>(y), *grid.log_odds.cellByIndex(x, y),
               *grid.hits.cellByIndex(x, y));
  }
  expectSameGrid(filled.unpacked(), grid);
  EXPECT_EQ(archived(filled), archived(PackedEvidence(grid)));
  EXPECT_EQ(filled.observedCells(), 6u);
}

TEST(PackedEvidence, KnowsWhatWasObserved) {
  PackedEvidence evidence(-5, 5, -5, 5, 0.1);
  EXPECT_TRUE(evidence.observedRange().empty());
  EXPECT_EQ(evidence.observedCells(), 0u);
  evidence.set(30, 7, -1, 2);
  evidence.set(12, 9, 1, 2);
  const CellRange range = evidence.observedRange();
  EXPECT_EQ(range.x_first, 12);
  EXPECT_EQ(range.x_last, 30);
  EXPECT_EQ(range.y_first, 7);
  EXPECT_EQ(range.y_last, 9);
  EXPECT_EQ(range.columns(), 19);
  EXPECT_EQ(range.rows(), 3);
}

TEST(PackedEvidence, MrptsGridHoldsTheProbabilityOfFreeSpace) {
  PackedEvidence evidence(0, 0.3, 0, 0.1, 0.1);
  evidence.set(0, 0, static_cast<float>(std::log(3.0)), 1);
  evidence.set(1, 0, -300, 100);
  const auto map = evidence.toOccupancyGrid();
  EXPECT_EQ(map.getSizeX(), 3u);
  EXPECT_NEAR(map.getPos(0.05f, 0.05f), 0.25, 0.02);
  EXPECT_GT(map.getPos(0.15f, 0.05f), 0.99f);
  EXPECT_NEAR(map.getPos(0.25f, 0.05f), 0.5, 0.01);
}

TEST(EvidenceSummary, SaysWhatIsThere) {
  const EvidenceSummary summary = summaryOf(PackedEvidence(sparseGrid()));
  EXPECT_EQ(summary.columns, 31);
  EXPECT_EQ(summary.rows, 23);
  EXPECT_NEAR(summary.x_min, -1.2, 1e-12);
  EXPECT_EQ(summary.observed_cells, 6u);
  EXPECT_NEAR(summary.least_log_odds_per_hit, -0.37, 1e-6);
  EXPECT_EQ(summaryOf(PackedEvidence(EvidenceGrid())).least_log_odds_per_hit, 0);
}

TEST(PackedEvidence, GivesCellsAndKnowsWhatALookUpReaches) {
  const EvidenceGrid grid = sparseGrid();
  const PackedEvidence packed(grid);
  const int nx = packed.sizeX(), ny = packed.sizeY();
  for (int y = -3; y < ny + 3; ++y)
    for (int x = -3; x < nx + 3; ++x) {
      const auto at = [&](int cx, int cy) {
        const float* hits = grid.hits.cellByIndex(static_cast<unsigned>(cx), static_cast<unsigned>(cy));
        return hits ? *hits : 0.0f;
      };
      EXPECT_EQ(packed.cell(x, y).second, at(x, y)) << x << " " << y;
      const bool seen = at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1) > 0;
      EXPECT_TRUE(packed.mayReach(x, y) || !seen) << x << " " << y;
    }
  EXPECT_FALSE(packed.mayReach(2, 17)) << "a corner without any observed cell near it";
  EXPECT_FALSE(packed.mayReach(-100, 1000));
}

TEST(UnloadedSubmap, KeepsItsEvidenceForEveryReader) {
  const auto submap = submapWith(sparseGrid());
  std::ostringstream before, after;
  submap->getDescriptionAsText(before);
  const double radius = submap->radius();
  submap->unload();
  submap->unload();  // again: no effect
  EXPECT_FALSE(submap->evidenceIsLoaded());
  EXPECT_EQ(submap->evidence.observedCells(), 0u);
  EXPECT_NEAR(submap->resolution(), 0.1, 1e-12);
  expectSameGrid(*LoadedEvidence(*submap), sparseGrid());
  EXPECT_FALSE(submap->evidenceIsLoaded()) << "reading leaves it unloaded";
  EXPECT_EQ(submap->radius(), radius);
  submap->getDescriptionAsText(after);
  EXPECT_EQ(after.str(), before.str());

  submap->load();
  EXPECT_TRUE(submap->evidenceIsLoaded());
  expectSameGrid(submap->evidence, sparseGrid());
}

TEST(UnloadedSubmap, GivesWhatItKeepsAndALoadedOneIsPacked) {
  const auto submap = submapWith(sparseGrid());
  expectSameGrid(submap->packedEvidence()->unpacked(), sparseGrid());
  EXPECT_TRUE(submap->evidenceIsLoaded()) << "packing leaves it loaded";
  submap->unload();
  EXPECT_EQ(submap->packedEvidence(), submap->packedEvidence()) << "no second copy";
  EXPECT_FALSE(submap->evidenceIsLoaded());
}

TEST(UnloadedSubmap, IsWrittenLikeALoadedOne) {
  const auto bytes = [](const GridSubmap& submap) {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << submap;
    const char* data = static_cast<const char*>(stream.getRawBufferData());
    return std::string(data, data + stream.getTotalBytesCount());
  };
  const auto submap = submapWith(sparseGrid());
  const std::string loaded = bytes(*submap);
  submap->unload();
  EXPECT_EQ(bytes(*submap), loaded);
}

TEST(UnloadedSubmap, FusesToTheSameMap) {
  const GridSubmaps submaps{submapWith(sparseGrid()), submapWith(sparseGrid())};
  std::vector<mrpt::poses::CPosePDFGaussian> frames(2);
  frames[1].mean = mrpt::poses::CPose2D(0.33, -0.21, 0.7);
  const EvidenceGrid loaded = fuseEvidence(submaps, frames, 0).unpacked();
  submaps[0]->unload();
  EXPECT_GT(loaded.observedCells(), 20u);
  expectSameGrid(fuseEvidence(submaps, frames, 0).unpacked(), loaded);
}

}  // namespace
}  // namespace submap_slam
