#include <gtest/gtest.h>
#include <submap_slam/output/landmark_files.h>

#include <limits>

#include "../support/temp_folder.h"
#include "sample_results.h"

namespace submap_slam {

TEST(WriteAssociations, LeavesEmptyWhatThereIsNot) {
  using Kind = FeatureAssociation::Kind;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const TempFolder folder;
  writeAssociations(
      folder.file("a.csv"),
      {{0, 7, Kind::kNew, 1, kNone}, {1, 8, Kind::kMatched, 1, 2.5}, {2, 9, Kind::kDropped, 0, 11}});
  EXPECT_EQ(readAll(folder.file("a.csv")),
            "submap,feature,kind,landmark,distance2\n0,7,new,1,\n1,8,matched,1,2.5\n2,9,dropped,,11\n");
}

}  // namespace submap_slam
