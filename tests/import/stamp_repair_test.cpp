#include "stamp_repair.h"

#include <gmock/gmock.h>

namespace submap_slam {
namespace {

using testing::ElementsAre;

TEST(StampRepair, KeepsStampsThatIncrease) {
  const auto repaired = repairStamps({1, 2, 5});
  EXPECT_THAT(repaired.stamps_s, ElementsAre(1, 2, 5));
  EXPECT_EQ(repaired.replaced, 0u);
}

TEST(StampRepair, ReplacesAsFewAsPossible) {
  // one stamp far ahead: those behind it are right
  const auto ahead = repairStamps({1, 2, 9, 4, 5});
  EXPECT_THAT(ahead.stamps_s, ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(ahead.replaced, 1u);
  EXPECT_DOUBLE_EQ(ahead.largest_shift_s, 6);
  // and one far behind
  EXPECT_THAT(repairStamps({1, 2, 0, 4, 5}).stamps_s, ElementsAre(1, 2, 3, 4, 5));
}

TEST(StampRepair, EqualStampsAreSpread) {
  const auto repaired = repairStamps({1, 2, 2, 2, 5});
  EXPECT_EQ(repaired.replaced, 2u);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_LT(repaired.stamps_s[i - 1], repaired.stamps_s[i]);
  EXPECT_EQ(repaired.stamps_s.front(), 1);
  EXPECT_EQ(repaired.stamps_s.back(), 5);
}

TEST(StampRepair, GoesOnWithTheMedianStepAtTheEnds) {
  EXPECT_THAT(repairStamps({9, 1, 3, 5, 7, 0}).stamps_s, ElementsAre(-1, 1, 3, 5, 7, 9));
}

TEST(StampRepair, TakesWhatThereIs) {
  EXPECT_TRUE(repairStamps({}).stamps_s.empty());
  EXPECT_THAT(repairStamps({4}).stamps_s, ElementsAre(4));
  const auto none = repairStamps({0, 0, 0});  // a log without stamps
  EXPECT_EQ(none.replaced, 2u);
  EXPECT_LT(none.stamps_s[0], none.stamps_s[1]);
  EXPECT_LT(none.stamps_s[1], none.stamps_s[2]);
}

}  // namespace
}  // namespace submap_slam
