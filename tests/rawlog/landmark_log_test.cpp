#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/submap_log.h>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const char* const kOneFeature =
    "MAP 1 5\n"
    "0 1.5\n"
    "0 -0.25\n"
    "0 0.125\n"
    "7 3\n"
    "7 4\n"
    "0.01\n"
    "0 0.01\n"
    "0 0 0.001\n"
    "0.002 0 0 0.04\n"
    "0 0 0 0 0.04\n";

/** The text with one of its lines, from 1, replaced. */
std::string withLine(int number, const std::string& line) {
  std::istringstream in(kOneFeature);
  std::string text, old;
  for (int i = 1; std::getline(in, old); ++i) text += (i == number ? line : old) + "\n";
  return text;
}

class LandmarkLog : public ::testing::Test {
 protected:
  LandmarkSubmaps read(const std::string& text) const {
    return readLandmarkSubmaps(temp_.write("s.txt", text));
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "no InputError";
    return {};
  }
  TempFolder temp_;
};

TEST_F(LandmarkLog, ReadsEveryNumberToItsPlace) {
  const auto submaps = read(kOneFeature);
  ASSERT_EQ(submaps.size(), 1u);
  const LandmarkSubmap& s = *submaps[0];
  EXPECT_EQ(s.end_pose, mrpt::math::TPose2D(1.5, -0.25, 0.125));
  ASSERT_EQ(s.features.size(), 1u);
  EXPECT_EQ(s.features[0].id, 7u);
  EXPECT_EQ(s.features[0].x, 3);
  EXPECT_EQ(s.features[0].y, 4);
  EXPECT_EQ(s.covariance(3, 0), 0.002);
  EXPECT_EQ(s.covariance(0, 3), 0.002);
  EXPECT_EQ(s.covariance(2, 2), 0.001);
  EXPECT_TRUE(s.end_stamp == INVALID_TIMESTAMP);
}

TEST_F(LandmarkLog, TextIsReadBackToTheSameBitsPackedOrNot) {
  const auto submaps = read(withLine(2, "0 0.1234567890123456789"));
  for (const char* name : {"copy.txt", "copy.txt.gz"}) {
    writeLandmarkText(temp_.file(name), submaps);
    EXPECT_TRUE(holdsLandmarkSubmaps(temp_.file(name)));
    const auto copy = readLandmarkSubmaps(temp_.file(name));
    ASSERT_EQ(copy.size(), 1u);
    EXPECT_EQ(copy[0]->end_pose, submaps[0]->end_pose);
    EXPECT_EQ(copy[0]->covariance, submaps[0]->covariance);
  }
  EXPECT_EQ(readAll(temp_.file("copy.txt")).substr(0, 8), "MAP 1 5\n");
  EXPECT_EQ(readAll(temp_.file("copy.txt.gz")).substr(0, 2), "\x1f\x8b");
  EXPECT_THROW(writeLandmarkText("/nowhere/s.txt", submaps), OutputError);
}

TEST_F(LandmarkLog, CommentsMayStandBeforeSubmaps) {
  const std::string two = std::string(kOneFeature) + "# the second\n" + kOneFeature;
  const std::string second = "MAP 1 5\n", text = "\n# MAP of a park\n#\n" + two;
  const auto at = text.rfind(second);
  const std::string file =
      temp_.write("c.txt", text.substr(0, at) + "MAP 2 5\n" + text.substr(at + second.size()));
  EXPECT_TRUE(holdsLandmarkSubmaps(file));
  EXPECT_EQ(readLandmarkSubmaps(file).size(), 2u);
  EXPECT_FALSE(holdsLandmarkSubmaps(temp_.write("d.txt", "# MAP 1 5\nMAPS\n")));
}

TEST_F(LandmarkLog, IdsInTextAreAboveZeroAndEqualOnlyWhereTheyAreKnown) {
  const std::string copy = temp_.file("copy.txt");
  auto a = read(kOneFeature).front(), b = read(kOneFeature).front();
  a->features[0].id = 0;
  writeLandmarkText(copy, {a, b});
  EXPECT_EQ(readLandmarkSubmaps(copy)[0]->features[0].id, 1u) << "0 marks the end pose";
  EXPECT_EQ(readLandmarkSubmaps(copy)[1]->features[0].id, 8u);
  a->ids_known = b->ids_known = false;
  b->features[0].id = 0;
  writeLandmarkText(copy, {a, b});
  EXPECT_EQ(readLandmarkSubmaps(copy)[0]->features[0].id, 1u);
  EXPECT_EQ(readLandmarkSubmaps(copy)[1]->features[0].id, 2u);
}

TEST_F(LandmarkLog, ReadsRawlogsOfLandmarkSubmaps) {
  auto submaps = read(kOneFeature);
  submaps[0]->features[0].hits = 6;
  const auto bytes = gzipMember(*submaps[0]);
  const std::string twice(bytes.begin(), bytes.end());
  const std::string file = temp_.write("s.rawlog", twice + twice);
  EXPECT_TRUE(holdsLandmarkSubmaps(file));
  const auto copy = readLandmarkSubmaps(file);
  ASSERT_EQ(copy.size(), 2u);
  EXPECT_EQ(copy[1]->id, 1u) << "the position in the file";
  EXPECT_EQ(copy[1]->features[0].hits, 6u);

  for (const std::size_t length : {twice.size() + twice.size() / 2, 2 * twice.size() - 4}) {
    const std::string part = temp_.write("part.rawlog", (twice + twice).substr(0, length));
    const auto recovered = recoverLandmarkSubmaps(part);
    EXPECT_EQ(recovered.submaps.size(), 1u) << "the good one before the cut";
    EXPECT_THAT(recovered.damage, HasSubstr("part.rawlog: entry 1"));
    EXPECT_THROW(readLandmarkSubmaps(part), InputError);
  }
  EXPECT_EQ(recoverLandmarkSubmaps(file).damage, "");

  const std::string cut = temp_.write("cut.rawlog", twice.substr(0, twice.size() / 2));
  EXPECT_THROW(recoverLandmarkSubmaps(cut), InputError) << "nothing of it is good";
  EXPECT_THROW(readLandmarkSubmaps(cut), InputError);
  submaps[0]->covariance(1, 1) = -1;
  const auto bad = gzipMember(*submaps[0]);
  const std::string damaged = temp_.write("bad.rawlog", twice + std::string(bad.begin(), bad.end()));
  try {
    readLandmarkSubmaps(damaged);
    ADD_FAILURE() << "no InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("bad.rawlog: entry 1"), HasSubstr("negative variance")));
  }
}

TEST_F(LandmarkLog, TellsOtherFilesApart) {
  GridSubmap grid;
  const auto bytes = gzipMember(grid);
  EXPECT_FALSE(holdsLandmarkSubmaps(temp_.write("g.rawlog", std::string(bytes.begin(), bytes.end()))));
  EXPECT_FALSE(holdsLandmarkSubmaps(temp_.write("empty.txt", "")));
  EXPECT_FALSE(holdsLandmarkSubmaps(temp_.write("other.txt", "no submaps")));
  EXPECT_THROW(holdsLandmarkSubmaps("/nowhere/none.txt"), InputError);
}

TEST_F(LandmarkLog, BadTextIsRefusedWithFileAndLine) {
  const auto refused = [&](int line, const std::string& text, const std::string& expected) {
    EXPECT_THAT(refusal(withLine(line, text)),
                AllOf(HasSubstr("s.txt:" + std::to_string(line) + ": "), HasSubstr(expected)));
  };
  refused(1, "MAP 2 5", "submap 2: expected 1");
  refused(1, "MAP 1 6", "3 + 2 n");
  refused(1, "MAP 1 2000001", "at most 4003");
  refused(1, "MAP 1 4005", "at most 4003");
  refused(1, "MAP 1", "the dimension of the state");
  refused(3, "0 nan", "'nan': expected a finite number");
  refused(3, "0 1e999", "expected a finite number");
  refused(3, "4 1", "id 4: expected 0 and y of the end pose");
  refused(5, "0 3", "expected that of a feature");
  refused(6, "8 4", "id 8: expected y of feature 7");
  refused(6, "7 4 4", "'4': expected nothing");
  refused(8, "0", "expected another number");
  refused(8, "0 0.01 0", "row 2 of the covariance of submap 1 with 2 numbers");
  EXPECT_THAT(refusal(withLine(11, "MAP")), HasSubstr("s.txt:11: 'MAP': expected a finite number"));
}

TEST_F(LandmarkLog, TextThatEndsTooEarlyIsRefused) {
  const std::string whole = kOneFeature;
  EXPECT_THAT(refusal(whole.substr(0, whole.find("7 4"))),
              AllOf(HasSubstr("s.txt:6: the file ends here"), HasSubstr("y of a feature")));
  EXPECT_THAT(refusal(whole.substr(0, whole.find("0 0 0 0 "))), HasSubstr("s.txt:11: the file ends here"));
}

TEST_F(LandmarkLog, BadCovariancesAreRefusedWhereTheSubmapBegins) {
  EXPECT_THAT(refusal("\n" + withLine(10, "0.2 0 0 0.04")),
              AllOf(HasSubstr("s.txt:2: submap 1"), HasSubstr("not positive definite")));
  EXPECT_THAT(refusal(withLine(11, "0 0 0 0 -0.04")), HasSubstr("negative variance"));
  EXPECT_THAT(refusal(withLine(11, "0 0 0 0 0")), HasSubstr("not positive definite"));
}

TEST_F(LandmarkLog, ASubmapWithoutFeaturesIsRead) {
  const auto submaps = read("MAP 1 3\n0 1\n0 2\n0 3\n0\n0 0\n0 0 0\n");
  EXPECT_TRUE(submaps.at(0)->features.empty()) << "and the robot stood still";
}

}  // namespace
}  // namespace submap_slam
