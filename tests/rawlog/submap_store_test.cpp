#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <tbb/parallel_for.h>

#include "../support/temp_folder.h"
#include "sample_submaps.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;

void writeSubmaps(const std::string& file, uint32_t count) {
  SubmapLogWriter writer(file, sampleRun());
  writer.appendStretch(sampleSubmaps(0, count));
  writer.finish();
}

std::size_t bytesOf(uint32_t id) { return sampleSubmap(id)->bulk().bytes(); }

void expectAllThere(const GridSubmaps& submaps) {
  for (uint32_t k = 0; k < submaps.size(); ++k) {
    EXPECT_EQ(gzipMember(*submaps[k]), gzipMember(*sampleSubmap(k))) << k;
    EXPECT_EQ(submaps[k]->keyNodes(), 1u);
    EXPECT_TRUE(submaps[k]->nodes[0].scans.empty()) << "held by the store only";
    EXPECT_EQ(submaps[k]->scans()[0].size(), 1u);
  }
}

TEST(SubmapStore, ReadsNothingTwiceWhileAllFits) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 4);
  const auto store = SubmapStore::create(1'000'000, temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  expectAllThere(submaps);
  EXPECT_EQ(store->timesRead(), 0u);
  EXPECT_FALSE(std::filesystem::exists(temp.file("spill")));
}

TEST(SubmapStore, DropsTheLeastRecentlyUsed) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 3);
  const std::size_t budget = bytesOf(0) + bytesOf(2) + 10;
  const auto store = SubmapStore::create(budget, temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  EXPECT_LE(store->bytesKept(), budget);
  EXPECT_EQ(submaps[0]->scans().size(), 2u);  // dropped for 2; now 1 goes
  EXPECT_EQ(store->timesRead(), 1u);
  EXPECT_EQ(submaps[2]->scans().size(), 2u);
  EXPECT_EQ(submaps[0]->scans().size(), 2u);
  EXPECT_EQ(store->timesRead(), 1u);
  EXPECT_EQ(submaps[1]->scans().size(), 2u);
  EXPECT_EQ(store->timesRead(), 2u);
}

TEST(SubmapStore, GivesTheSameWithoutAnyMemory) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 4);
  const auto store = SubmapStore::create(0, temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  EXPECT_EQ(store->bytesKept(), 0u);
  expectAllThere(submaps);
  EXPECT_GE(store->timesRead(), 4u);
  const auto held = submaps[1]->packedEvidence();
  EXPECT_EQ(submaps[1]->evidenceSummary().observed_cells, 1u);
  EXPECT_FLOAT_EQ(held->cell(3, 4).first, 1.5f);
}

TEST(SubmapStore, LeavesNoFileThatOthersCouldSee) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 3);
  const auto store = SubmapStore::create(0, temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  for (const auto& entry : std::filesystem::directory_iterator(temp.file("")))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(testing::StartsWith("spill")));
  expectAllThere(submaps);
}

/** As two runs that write to the same folder. */
TEST(SubmapStore, TwoStoresOfOneNameDoNotMeet) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 2);
  const auto a = SubmapStore::create(0, temp.file("spill")), b = SubmapStore::create(0, temp.file("spill"));
  const auto first = readSubmaps(temp.file("s.rawlog"), a);
  GridSubmap other = *sampleSubmap(7);
  b->takeOver(other);
  expectAllThere(first);
  EXPECT_EQ(gzipMember(other), gzipMember(*sampleSubmap(7)));
}

TEST(SubmapStore, DoesNotNeedTheFileThatSubmapsCameFrom) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 3);
  const auto store = SubmapStore::create(0, temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  std::filesystem::remove(temp.file("s.rawlog"));
  expectAllThere(submaps);
}

TEST(SubmapStore, TakesNothingWhereItCannotWrite) {
  TempFolder temp;
  const auto store = SubmapStore::create(0, temp.file("no such folder/spill"));
  GridSubmap submap = *sampleSubmap(0);
  EXPECT_THROW(store->takeOver(submap), OutputError);
  EXPECT_EQ(gzipMember(submap), gzipMember(*sampleSubmap(0)));
  EXPECT_FALSE(submap.nodes[0].scans.empty());
  EXPECT_EQ(store->bytesKept(), 0u);
}

TEST(SubmapStore, ServesManyThreads) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 6);
  const auto store = SubmapStore::create(bytesOf(0) + bytesOf(1), temp.file("spill"));
  const auto submaps = readSubmaps(temp.file("s.rawlog"), store);
  std::vector<float> seen(600);
  tbb::parallel_for(std::size_t{0}, seen.size(),
                    [&](std::size_t i) { seen[i] = submaps[i % 6]->packedEvidence()->cell(3, 4).first; });
  for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_FLOAT_EQ(seen[i], 0.5f + static_cast<float>(i % 6));
}

TEST(SubmapFormat, OpensFilesOfVersion0) {
  const auto submaps = readSubmaps(RAWLOG_TEST_DATA "/submaps_version_0.rawlog");
  ASSERT_EQ(submaps.size(), 3u);
  for (uint32_t k = 0; k < 3; ++k) EXPECT_EQ(gzipMember(*submaps[k]), gzipMember(*sampleSubmap(k)));
}

TEST(SubmapFormat, RefusesANewerVersionByName) {
  TempFolder temp;
  mrpt::io::CMemoryStream stream;
  mrpt::serialization::archiveFrom(stream) << *sampleSubmap(0);
  std::string bytes(static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount());
  const std::string name = "submap_slam::GridSubmap";
  char& version = bytes[bytes.find(name) + name.size()];
  ASSERT_EQ(version, 1);
  version = 2;
  try {
    readSubmaps(temp.write("newer.rawlog", bytes));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("newer.rawlog: entry 0 at byte 0: "));
    EXPECT_THAT(error.what(), HasSubstr("only newer versions of the program know its format"));
  }
}

}  // namespace
}  // namespace submap_slam
