#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CRawlog.h>
#include <submap_slam/core/errors.h>

#include "../support/temp_folder.h"
#include "sample_submaps.h"

namespace submap_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/** A file of `count` submaps; returns the size after each. */
std::vector<std::size_t> writeSubmaps(const std::string& file, uint32_t count) {
  SubmapLogWriter writer(file, sampleRun());
  std::vector<std::size_t> sizes;
  for (uint32_t k = 0; k < count; ++k) {
    writer.appendStretch({sampleSubmap(k)});
    sizes.push_back(writer.state().submap_bytes);
    EXPECT_EQ(std::filesystem::file_size(file), sizes.back());
  }
  writer.finish();
  return sizes;
}

std::string readError(const std::string& file) {
  try {
    readSubmaps(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SubmapLog, RoundTrip) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  writeSubmaps(file, 4);
  const auto submaps = readSubmaps(file);
  ASSERT_EQ(submaps.size(), 4u);
  for (uint32_t k = 0; k < 4; ++k) {
    const auto& submap = *submaps[k];
    const auto wanted = sampleSubmap(k);
    EXPECT_EQ(submap.id, k);
    EXPECT_EQ(submap.timestamp, wanted->timestamp);
    EXPECT_EQ(submap.first_frame, 10 * k);
    EXPECT_FALSE(submap.evidenceIsLoaded());
    const LoadedEvidence evidence(submap);
    ASSERT_EQ(evidence->cells(), wanted->evidence.cells());
    EXPECT_EQ(*evidence->log_odds.cellByIndex(3, 4), 0.5f + static_cast<float>(k));
    ASSERT_EQ(submap.nodes.size(), 2u);
    EXPECT_EQ(submap.nodes[1].pose, wanted->nodes[1].pose);
    EXPECT_EQ(submap.keyNodes(), 1u);
    EXPECT_EQ(submap.end_pose.mean, wanted->end_pose.mean);
    EXPECT_EQ(gzipMember(submap), gzipMember(*wanted));
  }
}

TEST(SubmapLog, AFollowerReadsWhatIsNew) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  SubmapLogWriter writer(file, sampleRun());
  const auto store = SubmapStore::create(0, temp.file("spill"));
  for (const auto& keeper : {std::shared_ptr<SubmapStore>{}, store}) {
    SubmapFollower follower(file, keeper);
    follower.readNew();
    EXPECT_TRUE(follower.readNew().empty());
    writer.appendStretch({sampleSubmap(0)});
    ASSERT_EQ(follower.readNew().size(), 1u);
    writer.appendStretch({sampleSubmap(1), sampleSubmap(2)});
    const GridSubmaps submaps = follower.readNew();
    ASSERT_EQ(submaps.size(), 2u);
    EXPECT_EQ(gzipMember(*submaps[0]), gzipMember(*sampleSubmap(1)));
    EXPECT_EQ(gzipMember(*submaps[1]), gzipMember(*sampleSubmap(2)));
  }
}

TEST(SubmapLog, StockReaderReadsAllObjects) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  writeSubmaps(file, 3);
  mrpt::io::CFileGZInputStream in(file);
  auto archive = mrpt::serialization::archiveFrom(in);
  for (uint32_t k = 0; k < 3; ++k) {
    const auto submap = std::dynamic_pointer_cast<GridSubmap>(archive.ReadObject());
    ASSERT_TRUE(submap);
    EXPECT_EQ(submap->id, k);
  }
  EXPECT_THROW(archive.ReadObject(), mrpt::serialization::CExceptionEOF);
  mrpt::obs::CRawlog rawlog;
  EXPECT_TRUE(rawlog.loadFromRawLogFile(file));
  EXPECT_EQ(rawlog.size(), 3u);
}

TEST(SubmapLog, SameSubmapsSameBytes) {
  TempFolder temp;
  writeSubmaps(temp.file("a.rawlog"), 3);
  writeSubmaps(temp.file("b.rawlog"), 3);
  const auto bytes = readAll(temp.file("a.rawlog"));
  EXPECT_EQ(bytes, readAll(temp.file("b.rawlog")));
  EXPECT_EQ(bytes.substr(4, 4), std::string(4, '\0')) << "the time in the gzip header";
  const auto member = gzipMember(*sampleSubmap(0));
  EXPECT_EQ(bytes.substr(0, member.size()), std::string(member.begin(), member.end()));
}

TEST(SubmapLog, RecoversTheSubmapsBeforeATruncatedOne) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  const auto sizes = writeSubmaps(file, 3);
  const auto whole = readAll(file);
  for (std::size_t length = sizes[1]; length < sizes[2]; length += 1 + (sizes[2] - sizes[1]) / 40) {
    const auto cut = temp.write("cut.rawlog", whole.substr(0, length));
    const auto recovered = recoverSubmaps(cut);
    EXPECT_EQ(recovered.submaps.size(), 2u) << length;
    EXPECT_EQ(recovered.valid_bytes, sizes[1]) << length;
    EXPECT_EQ(recovered.damage.empty(), length == sizes[1]) << length;
  }
  const auto last_byte_missing = recoverSubmaps(temp.write("cut.rawlog", whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(last_byte_missing.submaps.size(), 2u);
  EXPECT_EQ(last_byte_missing.valid_bytes, sizes[1]);
  const auto all = recoverSubmaps(file);
  EXPECT_EQ(all.submaps.size(), 3u);
  EXPECT_EQ(all.valid_bytes, sizes[2]);
  EXPECT_EQ(all.damage, "");
}

TEST(SubmapLog, FlippedBytesNeverGiveAnotherSubmap) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  const auto sizes = writeSubmaps(file, 2);
  const auto whole = readAll(file);
  const auto wanted = gzipMember(*sampleSubmap(1));
  int noticed = 0, tried = 0;
  for (std::size_t at = sizes[0]; at < sizes[1]; at += 1 + (sizes[1] - sizes[0]) / 60, ++tried) {
    auto bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    const auto recovered = recoverSubmaps(temp.write("bad.rawlog", bytes));
    // harmless: the header's time, or a copy taken from elsewhere in a run of equal bytes
    const bool unharmed = recovered.submaps.size() == 2 && gzipMember(*recovered.submaps[1]) == wanted;
    if (unharmed) continue;
    ++noticed;
    EXPECT_EQ(recovered.submaps.size(), 1u) << at;
    EXPECT_EQ(recovered.valid_bytes, sizes[0]) << at;
    EXPECT_NE(recovered.damage, "") << at;
  }
  EXPECT_GT(noticed, tried / 2);
}

TEST(SubmapLog, DamageIsNamedWithWhatIsValid) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  const auto sizes = writeSubmaps(file, 3);
  const auto cut = temp.write("cut.rawlog", readAll(file).substr(0, sizes[1] + 20));
  EXPECT_THAT(readError(cut),
              AllOf(HasSubstr(cut), HasSubstr("entry 2"), HasSubstr("2 submaps before it are valid")));
}

TEST(SubmapLog, OtherContentIsRefused) {
  TempFolder temp;
  EXPECT_THAT(readError(temp.write("empty", "")), HasSubstr("no submaps"));
  EXPECT_THAT(readError(temp.write("text", "text, just text")), HasSubstr("no rawlog"));
  EXPECT_THAT(readError(temp.file("missing")), HasSubstr("no such file"));
  LogBuilder sensors;
  EXPECT_THAT(readError(sensors.add(scanAt(0)).saveGz(temp.file("sensors.rawlog"))),
              AllOf(HasSubstr("CObservation2DRangeScan"), HasSubstr("GridSubmap")));
}

TEST(SubmapLog, ReadsSubmapsThatOtherToolsPackedIntoOneMember) {
  TempFolder temp;
  LogBuilder log;
  for (uint32_t k = 0; k < 3; ++k) log.add(*sampleSubmap(k));
  EXPECT_EQ(readSubmaps(log.saveGz(temp.file("one.rawlog"))).size(), 3u);
  EXPECT_EQ(readSubmaps(log.savePlain(temp.file("plain.rawlog"))).size(), 3u);
  const auto cut = recoverSubmaps(temp.write("cut.rawlog", log.bytes().substr(0, log.ends()[1] + 7)));
  EXPECT_EQ(cut.submaps.size(), 2u);
  EXPECT_EQ(cut.valid_bytes, log.ends()[1]);
}

TEST(SubmapLog, RawlogReaderSaysThatItIsNoSensorLog) {
  TempFolder temp;
  writeSubmaps(temp.file("s.rawlog"), 1);
  const auto report = checkLog(temp.file("s.rawlog"));
  EXPECT_THAT(report.asText(), HasSubstr("holds submaps"));
}

}  // namespace
}  // namespace submap_slam
