#include <submap_slam/core/packed_evidence.h>

#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/joined_map.h>

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
  expectSameGrid(packedEvidenceOf(*submap)->unpacked(), sparseGrid());
  EXPECT_TRUE(submap->evidenceIsLoaded()) << "packing leaves it loaded";
  submap->unload();
  EXPECT_EQ(packedEvidenceOf(*submap), submap->packedEvidence()) << "no second copy";
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
  const EvidenceGrid loaded = fuseEvidence(submaps, frames, 0);
  submaps[0]->unload();
  EXPECT_GT(loaded.observedCells(), 20u);
  expectSameGrid(fuseEvidence(submaps, frames, 0), loaded);
}

}  // namespace
}  // namespace submap_slam
