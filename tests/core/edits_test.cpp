#include "../support/temp_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/edits.h>
#include <submap_slam/core/errors.h>

#include <cmath>

namespace submap_slam {
namespace {

using ::testing::HasSubstr;

/** Submaps 10, 11, 12 and 13, each with one observed cell and one scan. */
GridSubmaps fourSubmaps() {
  GridSubmaps submaps;
  for (uint32_t id = 10; id < 14; ++id) {
    auto submap = GridSubmap::Create();
    submap->id = id;
    submap->evidence = EvidenceGrid(-1, 1, -1, 1, 0.1);
    *submap->evidence.hits.cellByPos(0.5, 0.5) = 1;
    submap->nodes.resize(2);
    submap->nodes.front().scans.push_back(mrpt::obs::CObservation2DRangeScan::Create());
    submaps.push_back(submap);
  }
  return submaps;
}

class EditsTest : public ::testing::Test {
 protected:
  Edits read(const std::string& text) const { return readEdits(folder.write("edits.txt", text)); }

  /** What the error says behind the name of the file. */
  std::string errorOf(const std::string& text) const {
    try {
      checkEdits(read(text), fourSubmaps());
    } catch (const InputError& error) {
      const std::string what = error.what(), file = folder.file("edits.txt");
      EXPECT_EQ(what.compare(0, file.size(), file), 0) << what;
      return what.substr(file.size());
    }
    return "no error";
  }

  TempFolder folder;
};

TEST_F(EditsTest, ReadsEveryFormAndComments) {
  const Edits edits = read(
      "# by me\n\nreject 12 10 # wrong room\r\n\tadd 10 13 1 -2 0.5\nadd 11 13 1 -2e0 .5 0.2 0.1\n"
      "fix 12 3 4 -0.5\nmask  11");
  ASSERT_EQ(edits.list.size(), 5u);
  EXPECT_EQ(edits.list[0].kind, Edit::Kind::kReject);
  EXPECT_EQ(edits.list[0].line, 3u);
  EXPECT_EQ(edits.list[0].text, "reject 12 10");
  EXPECT_EQ(edits.list[1].pose, mrpt::math::TPose2D(1, -2, 0.5));
  EXPECT_EQ(edits.list[1].sigma_xy, 0.05);
  EXPECT_EQ(edits.list[1].sigma_phi, 0.01);
  EXPECT_EQ(edits.list[2].pose, mrpt::math::TPose2D(1, -2, 0.5));
  EXPECT_EQ(edits.list[2].sigma_xy, 0.2);
  EXPECT_EQ(edits.list[2].sigma_phi, 0.1);
  EXPECT_EQ(edits.list[3].to, 12u);
  EXPECT_EQ(edits.list[3].pose, mrpt::math::TPose2D(3, 4, -0.5));
  EXPECT_EQ(edits.list[4].text, "mask 11");
  EXPECT_TRUE(edits.masks(11));
  EXPECT_FALSE(edits.masks(12));
  checkEdits(edits, fourSubmaps());
}

TEST_F(EditsTest, ReadsFilesOfOtherEditors) {
  EXPECT_TRUE(read("\xEF\xBB\xBFmask 12\r\n").masks(12));
  EXPECT_TRUE(read("").list.empty());
  EXPECT_TRUE(read("# nothing").list.empty());
}

TEST_F(EditsTest, BecomeConstraintsByHand) {
  const auto constraints = constraintsOf(
      read("reject 12 10\nadd 11 13 1 -2 0.5 0.2 0.1\nfix 12 3 4 -0.5\nmask 11"), fourSubmaps());
  ASSERT_EQ(constraints.size(), 3u);
  for (const Constraint& c : constraints) EXPECT_TRUE(c.by_hand && c.inter);
  EXPECT_FALSE(constraints[0].accepted);
  EXPECT_EQ(constraints[0].from, 12u);
  EXPECT_EQ(constraints[0].to, 10u);
  EXPECT_EQ(constraints[0].reason, "rejected by hand");
  EXPECT_TRUE(constraints[1].accepted);
  EXPECT_EQ(constraints[1].from, 11u);
  EXPECT_EQ(constraints[1].to, 13u);
  EXPECT_EQ(constraints[1].T_a_b.mean.asTPose(), mrpt::math::TPose2D(1, -2, 0.5));
  EXPECT_DOUBLE_EQ(constraints[1].T_a_b.cov(1, 1), 0.04);
  EXPECT_DOUBLE_EQ(constraints[1].T_a_b.cov(2, 2), 0.01);
  EXPECT_EQ(constraints[1].T_a_b.cov(0, 1), 0);
  EXPECT_EQ(constraints[1].reason, "added by hand");
  EXPECT_EQ(constraints[2].from, 10u) << "a fixed frame is seen from the first one";
  EXPECT_EQ(constraints[2].to, 12u);
  EXPECT_LE(std::sqrt(constraints[2].T_a_b.cov(0, 0)), 0.001);
  EXPECT_EQ(constraints[2].reason, "fixed by hand");
}

TEST_F(EditsTest, MaskedSubmapsLoseTheirObservationsInCopies) {
  for (const bool packed : {false, true}) {
    const GridSubmaps submaps = fourSubmaps();
    if (packed) submaps[1]->unload();
    const GridSubmaps masked = maskSubmaps(submaps, read("mask 11"));
    ASSERT_EQ(masked.size(), 4u);
    EXPECT_EQ(masked[0], submaps[0]);
    EXPECT_EQ(LoadedEvidence(*masked[1])->observedCells(), 0u);
    EXPECT_DOUBLE_EQ(masked[1]->resolution(), 0.1);
    EXPECT_EQ(masked[1]->id, 11u);
    EXPECT_EQ(masked[1]->nodes.size(), 2u);
    EXPECT_EQ(masked[1]->keyNodes(), 0u);
    EXPECT_EQ(LoadedEvidence(*submaps[1])->observedCells(), 1u) << "the submap itself stays as it is";
    EXPECT_EQ(submaps[1]->keyNodes(), 1u);
  }
}

TEST_F(EditsTest, SaysWhatIsWrongInWhichLine) {
  EXPECT_THAT(errorOf("# first\nrejekt 10 12"), HasSubstr(":2: unknown word 'rejekt'; expected reject, add"));
  EXPECT_THAT(errorOf("reject"), HasSubstr(":1: 'reject': expected reject FROM TO"));
  EXPECT_THAT(errorOf("reject 10 12 13"), HasSubstr("expected reject FROM TO"));
  EXPECT_THAT(errorOf("mask 10 11"), HasSubstr("expected mask ID"));
  EXPECT_THAT(errorOf("fix 12 1 2"), HasSubstr("expected fix ID X Y PHI"));
  EXPECT_THAT(errorOf("add 10 12 1 2 3 0.1"), HasSubstr("expected add FROM TO X Y PHI [SIGMA_XY SIGMA_PHI]"));
  EXPECT_THAT(errorOf("mask -1"), HasSubstr("'-1' is not the id of a submap"));
  EXPECT_THAT(errorOf("mask 1.5"), HasSubstr("'1.5' is not the id of a submap"));
  EXPECT_THAT(errorOf("mask 99999999999"), HasSubstr("is not the id of a submap"));
  EXPECT_THAT(errorOf("fix 12 1 2 3m"), HasSubstr("'3m' is not a number; expected fix ID X Y PHI"));
  EXPECT_THAT(errorOf("fix 12 1 nan 3"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(errorOf("add 10 12 1 2 3 0 1"), HasSubstr("'0' is no standard deviation"));
  EXPECT_THAT(errorOf("add 10 10 1 2 3"), HasSubstr("expected two submaps"));
}

TEST_F(EditsTest, RefusesWhatIsSaidTwice) {
  EXPECT_THAT(errorOf("reject 12 10\nreject 10 12"), HasSubstr(":2: 'reject 10 12': line 1 said so"));
  EXPECT_THAT(errorOf("fix 12 1 2 3\n\nfix 12 1 2 4"), HasSubstr(":3: 'fix 12 1 2 4': line 1 said so"));
  EXPECT_EQ(errorOf("reject 12 10\nadd 12 10 1 2 3\nfix 12 0 0 0\nmask 12"), "no error");
}

TEST_F(EditsTest, RefusesWhatTheSubmapsDoNotAllow) {
  EXPECT_THAT(errorOf("mask 11\nmask 9"), HasSubstr(":2: there is no submap 9; expected 10 to 13"));
  EXPECT_THAT(errorOf("reject 14 10"), HasSubstr("there is no submap 14"));
  EXPECT_THAT(errorOf("add 10 14 0 0 0"), HasSubstr("there is no submap 14"));
  EXPECT_THAT(errorOf("fix 10 0 0 0"), HasSubstr("expected another submap"));
  EXPECT_THAT(errorOf("reject 12 11"), HasSubstr("12 and 11 follow each other; expected a loop closure"));
  EXPECT_THAT(errorOf("mask 10\nmask 11\nmask 12\nmask 13"), HasSubstr("masks every submap"));
}

TEST_F(EditsTest, RefusesFilesThatAreNotThere) {
  EXPECT_THROW(readEdits(folder.file("missing.txt")), InputError);
  EXPECT_THROW(readEdits(std::filesystem::path(folder.file("x")).parent_path().string()), InputError);
}

}  // namespace
}  // namespace submap_slam
