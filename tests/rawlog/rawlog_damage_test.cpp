#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <submap_slam/core/errors.h>

#include <algorithm>

#include "../support/temp_folder.h"
#include "log_builder.h"

namespace submap_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Outcome {
  std::size_t frames = 0;
  std::string error;
};

/** Reads until the end or the error, and checks that an error comes once. */
Outcome readDamaged(const std::string& file) {
  RawlogReader reader(file);
  Outcome outcome;
  try {
    while (reader.next()) ++outcome.frames;
  } catch (const InputError& error) {
    outcome.error = error.what();
  }
  EXPECT_FALSE(reader.next()) << "the error must be thrown once";
  EXPECT_EQ(reader.report().frames, outcome.frames);
  return outcome;
}

LogBuilder sampleLog(int frames) {
  LogBuilder log;
  for (int k = 0; k < frames; ++k) log.add(movement(0.1, 0, 0.01)).addFrame({scanAt(k)});
  return log;
}

TEST(RawlogDamage, EveryPrefixOfAPlainLogGivesItsWholeFrames) {
  TempFolder temp;
  const auto log = sampleLog(6);
  const auto& ends = log.ends();
  for (std::size_t length = 1; length < log.bytes().size(); length += 7) {
    const auto file = temp.write("cut.rawlog", log.bytes().substr(0, length));
    const auto outcome = readDamaged(file);
    const auto whole =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), length) - ends.begin());
    EXPECT_EQ(outcome.frames, whole / 2) << length;
    const bool at_end = whole > 0 && ends[whole - 1] == length;
    if (!at_end || whole < 2) {
      EXPECT_THAT(outcome.error, HasSubstr(file)) << length;
      EXPECT_EQ(outcome.error.find('\n'), std::string::npos) << length;
    } else {
      EXPECT_EQ(outcome.error, "") << length;
    }
  }
}

TEST(RawlogDamage, EveryPrefixOfAGzipLogIsAnErrorWithGrowingFrames) {
  TempFolder temp;
  const auto whole = readAll(sampleLog(60).saveGz(temp.file("whole.rawlog")));
  std::size_t last = 0;
  for (std::size_t length = 3; length < whole.size(); length += 1 + whole.size() / 200) {
    const auto outcome = readDamaged(temp.write("cut.rawlog", whole.substr(0, length)));
    EXPECT_NE(outcome.error, "") << length;
    EXPECT_GE(outcome.frames, last) << length;
    last = outcome.frames;
  }
  EXPECT_GT(last, 50u);
  EXPECT_EQ(readDamaged(temp.write("all.rawlog", whole)).error, "");
}

TEST(RawlogDamage, MissingGzipTrailerIsNoticed) {
  TempFolder temp;
  const auto whole = readAll(sampleLog(20).saveGz(temp.file("whole.rawlog")));
  const auto outcome = readDamaged(temp.write("cut.rawlog", whole.substr(0, whole.size() - 1)));
  EXPECT_EQ(outcome.frames, 20u);
  EXPECT_THAT(outcome.error, HasSubstr("gzip"));
}

TEST(RawlogDamage, WrongChecksumIsNoticed) {
  TempFolder temp;
  auto whole = readAll(sampleLog(20).saveGz(temp.file("whole.rawlog")));
  whole[whole.size() - 8] = static_cast<char>(whole[whole.size() - 8] ^ 1);
  EXPECT_THAT(readDamaged(temp.write("bad.rawlog", whole)).error,
              AllOf(HasSubstr("corrupt"), HasSubstr("data check")));
}

TEST(RawlogDamage, RubbishBetweenObjectsIsNamedWithItsOffset) {
  TempFolder temp;
  const auto log = sampleLog(4);
  const auto at = log.ends()[3];
  const auto file = temp.write("bad.rawlog", log.bytes().substr(0, at) + "rubbish" + log.bytes().substr(at));
  const auto outcome = readDamaged(file);
  EXPECT_EQ(outcome.frames, 2u);
  EXPECT_THAT(outcome.error, AllOf(HasSubstr("entry 4"), HasSubstr("byte " + std::to_string(at))));
  const auto report = checkLog(file);
  ASSERT_TRUE(report.damage);
  EXPECT_FALSE(report.damage->truncated);
  EXPECT_EQ(report.damage->data_byte, at);
  EXPECT_EQ(report.damage->entry, 4u);
  EXPECT_TRUE(report.hasErrors());
}

TEST(RawlogDamage, TruncationIsReportedAsSuch) {
  TempFolder temp;
  const auto log = sampleLog(4);
  const auto report = checkLog(temp.write("cut.rawlog", log.bytes().substr(0, log.bytes().size() - 5)));
  ASSERT_TRUE(report.damage);
  EXPECT_TRUE(report.damage->truncated);
  EXPECT_EQ(report.damage->data_byte, log.ends()[6]);
  EXPECT_EQ(report.frames, 3u);
}

/** Replaces every occurrence by a text of the same length. */
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

TEST(RawlogDamage, UnknownClassIsNamed) {
  TempFolder temp;
  LogBuilder log;
  log.add(scanAt(0));
  const auto other = LogBuilder().add(odometryAt(1, 0, 0, 0)).bytes();
  const auto file =
      temp.write("a.rawlog", log.bytes() + replaced(other, "CObservationOdometry", "CObservationXdometry"));
  const auto outcome = readDamaged(file);
  EXPECT_EQ(outcome.frames, 1u);
  EXPECT_THAT(outcome.error, AllOf(HasSubstr("mrpt::obs::CObservationXdometry"), HasSubstr("does not know")));
}

TEST(RawlogDamage, WrongVersionInsideAnObjectIsNoCrash) {
  TempFolder temp;
  auto bytes = sampleLog(3).bytes();
  const std::string name = "CObservation2DRangeScan";
  bytes[bytes.find(name) + name.size()] = 99;
  const auto outcome = readDamaged(temp.write("a.rawlog", bytes));
  EXPECT_EQ(outcome.frames, 0u);
  EXPECT_THAT(outcome.error, HasSubstr("makes no sense"));
}

TEST(RawlogDamage, ObjectsMayEndAnywhereInTheBuffers) {
  TempFolder temp;
  const std::size_t buffer = 65536, scan_bytes = LogBuilder().add(scanAt(0)).bytes().size();
  mrpt::obs::CObservationComment comment;
  const std::size_t comment_bytes = LogBuilder().add(comment).bytes().size();
  for (std::size_t end = buffer - 60; end <= buffer + 60; end += 5) {  // of the first scan
    comment.text = std::string(end - scan_bytes - comment_bytes, '.');
    LogBuilder log;
    log.add(comment).add(scanAt(0)).add(scanAt(1));
    ASSERT_EQ(log.ends()[1], end);
    EXPECT_EQ(readDamaged(log.saveGz(temp.file("a.rawlog"))).frames, 2u) << end;
  }
  comment.text = std::string(buffer - scan_bytes - comment_bytes, '.');
  EXPECT_EQ(readDamaged(LogBuilder().add(comment).add(scanAt(0)).add(scanAt(1)).saveGz(temp.file("b.rawlog")))
                .frames,
            2u);
  EXPECT_EQ(readDamaged(LogBuilder().add(comment).add(scanAt(0)).saveGz(temp.file("c.rawlog"))).frames, 1u);
}

TEST(RawlogDamage, AbsurdCountsAreRefusedBeforeMemoryIsAllocated) {
  TempFolder temp;
  auto scan = scanAt(0);
  scan.resizeScan(5);
  auto scans = LogBuilder().add(scan).bytes(), actions = LogBuilder().add(movement(1, 0, 0)).bytes();
  const std::string count_of_beams("\x88\x05\x00\x00\x00", 5), label("\x05\x00\x00\x00LASER", 9);
  const auto in_scan = scans.find(count_of_beams), in_label = scans.find(label);
  const auto in_actions = std::string(1 + 28 + 1, ' ').size();  // behind length, name and version
  ASSERT_NE(in_scan, std::string::npos);
  ASSERT_NE(in_label, std::string::npos);
  const auto with_high_byte = [](std::string bytes, std::size_t at) {
    bytes.at(at + 3) = '\x7f';
    return bytes;
  };
  for (const auto& bytes : {with_high_byte(scans, in_scan + 1), with_high_byte(scans, in_label),
                            with_high_byte(actions, in_actions)}) {
    const auto outcome = readDamaged(temp.write("a.rawlog", bytes));
    EXPECT_EQ(outcome.frames, 0u);
    EXPECT_THAT(outcome.error, HasSubstr("makes no sense"));
  }
}

TEST(RawlogDamage, ScansOfAnySizeAreNoAbsurdCount) {
  TempFolder temp;
  LogBuilder log;
  for (std::size_t beams = 1; beams < 12; ++beams) {
    auto scan = scanAt(static_cast<double>(beams));
    scan.beamAperture = 0.01f;
    scan.resizeScanAndAssign(beams, 3.0f, true);
    log.add(scan);
  }
  EXPECT_EQ(readDamaged(log.savePlain(temp.file("a.rawlog"))).frames, 11u);
}

TEST(RawlogDamage, InnerObjectsOfAWrongClassAreRefused) {
  TempFolder temp;
  auto bytes = LogBuilder().add(movement(1, 0, 0)).bytes();
  const std::string name = "CActionRobotMovement2D";
  auto& method = bytes[bytes.find(name) + name.size() + 1];
  ASSERT_EQ(method, 0);
  method = 1;  // promises a distribution where a pose is stored
  EXPECT_THAT(readDamaged(temp.write("a.rawlog", bytes)).error, HasSubstr("makes no sense"));
}

TEST(RawlogDamage, FlippedBitsNeverCrash) {
  TempFolder temp;
  const auto bytes = sampleLog(2).bytes();
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    auto flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (at / 3 % 8)));
    EXPECT_LE(checkLog(temp.write("a.rawlog", flipped)).frames, 2u) << at;
  }
}

TEST(RawlogDamage, CheckNeverThrowsForContent) {
  TempFolder temp;
  EXPECT_TRUE(checkLog(temp.write("empty", "")).hasErrors());
  EXPECT_TRUE(checkLog(temp.write("text", "text")).hasErrors());
  EXPECT_THROW(checkLog(temp.file("missing")), InputError);
}

}  // namespace
}  // namespace submap_slam
