#include <gtest/gtest.h>
#include <submap_slam/core/doubtful_ends.h>

namespace submap_slam {
namespace {

/** Submaps with the ids 10, 11, …, of which some have a doubtful end. */
GridSubmaps submapsWithDoubt(std::size_t count, const std::vector<std::size_t>& doubtful) {
  GridSubmaps submaps;
  for (std::size_t k = 0; k < count; ++k) {
    auto submap = GridSubmap::Create();
    submap->id = static_cast<uint32_t>(10 + k);
    submap->has_successor = k + 1 < count;
    submap->end_pose.cov.setDiagonal(1e-4);
    submaps.push_back(submap);
  }
  for (const std::size_t k : doubtful) submaps[k]->end_pose.cov(2, 2) = 0.01;
  return submaps;
}

Constraint loop(uint32_t from, uint32_t to) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.inter = true;
  return constraint;
}

TEST(DoubtfulEnds, AreUncertainOrMissing) {
  const auto submaps = submapsWithDoubt(4, {1});
  EXPECT_FALSE(endIsDoubtful(*submaps[0]));
  EXPECT_TRUE(endIsDoubtful(*submaps[1]));
  EXPECT_TRUE(endIsDoubtful(*submaps[3])) << "nothing follows";
  submaps[0]->end_pose.cov(1, 1) = 0.02;
  EXPECT_TRUE(endIsDoubtful(*submaps[0]));
}

TEST(Breaks, AreWhereNothingElseLinks) {
  const auto submaps = submapsWithDoubt(6, {1, 3});
  EXPECT_EQ(breaksOf(submaps, {}), (std::vector<std::size_t>{2, 4}));
  EXPECT_EQ(breaksOf(submaps, {loop(15, 11)}), (std::vector<std::size_t>{2}));
  EXPECT_EQ(breaksOf(submaps, {loop(15, 11), loop(12, 14)}), (std::vector<std::size_t>{}));
  EXPECT_TRUE(breaksOf({}, {}).empty());
}

TEST(Breaks, AreNotMendedByWhatIsNoLoop) {
  const auto submaps = submapsWithDoubt(3, {0});
  Constraint refused = loop(12, 10), chain = loop(10, 11), unknown = loop(99, 10), by_hand = loop(12, 10);
  refused.accepted = false;
  chain.inter = false;
  EXPECT_EQ(breaksOf(submaps, {refused, chain, unknown}), (std::vector<std::size_t>{1}));
  by_hand.inter = false;
  by_hand.by_hand = true;
  EXPECT_TRUE(breaksOf(submaps, {by_hand}).empty());
}

TEST(Breaks, InWords) {
  EXPECT_EQ(describeBreaks(submapsWithDoubt(3, {}), {}), "");
  EXPECT_NE(describeBreaks(submapsWithDoubt(6, {1, 3}), {}).find("before submap 12, 14:"), std::string::npos);
  EXPECT_NE(describeBreaks(submapsWithDoubt(9, {0, 1, 2, 3, 4, 5, 6}), {}).find("13, 14, 15 and 2 more"),
            std::string::npos);
}

}  // namespace
}  // namespace submap_slam
