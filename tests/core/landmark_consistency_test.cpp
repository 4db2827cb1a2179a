#include <gmock/gmock.h>
#include <submap_slam/core/landmark_consistency.h>

#include <Eigen/Core>
#include <memory>

namespace submap_slam {
namespace {

using testing::HasSubstr;

constexpr double kPi = 3.141592653589793;

/** Ten submaps of 2 m, each of which sees landmarks 1 to 3; all variances are 0.01. The frames are turned by
 * 90° to the global map frame. */
struct Case {
  LandmarkSubmaps submaps;
  JoinedLandmarks joined;
};

Case exactCase() {
  Case c;
  for (uint32_t id : {1u, 2u, 3u}) {
    JoinedLandmark landmark;
    landmark.id = id;
    landmark.x = -3;
    landmark.y = 2.0 * id;
    c.joined.landmarks.push_back(landmark);
  }
  for (uint32_t k = 0; k < 10; ++k) {
    auto submap = std::make_shared<LandmarkSubmap>();
    submap->id = k;
    submap->end_pose.x = 2;
    c.joined.frames.emplace_back().mean = mrpt::poses::CPose2D(0, 2.0 * k, kPi / 2);
    for (uint32_t id : {1u, 2u, 3u}) {
      submap->features.push_back({id, 2.0 * id - 2.0 * k, 3, 1});
      c.joined.associations.push_back({k, id, FeatureAssociation::Kind::kKnown, id, 0});
    }
    submap->covariance.setIdentity(static_cast<int>(submap->dimension()));
    submap->covariance.asEigen() *= 0.01;
    c.submaps.push_back(submap);
  }
  c.joined.frames.emplace_back();
  c.joined.status = JoinStatus::kConverged;
  return c;
}

TEST(LandmarkConsistency, FindsTheFeatureThatFitsWorst) {
  Case c = exactCase();
  EXPECT_NEAR(worstMisfit(c.submaps, c.joined)->distance2, 0, 1e-20);
  c.submaps[4]->features[1].x += 0.3;
  c.submaps[6]->features[2].y += 0.4;
  c.submaps[6]->covariance(8, 8) = 0.16;  // so that this counts less
  const auto worst = worstMisfit(c.submaps, c.joined);
  ASSERT_TRUE(worst);
  EXPECT_EQ(worst->submap, 4u);
  EXPECT_EQ(worst->landmark, 2u);
  EXPECT_NEAR(worst->distance_m, 0.3, 1e-9);
  EXPECT_NEAR(worst->distance2, 0.09 / 0.01, 1e-9);
  c.joined.associations[4 * 3 + 1].kind = FeatureAssociation::Kind::kDropped;
  EXPECT_EQ(worstMisfit(c.submaps, c.joined)->submap, 6u);
  EXPECT_FALSE(worstMisfit({}, {}));
}

TEST(LandmarkConsistency, TellsWhereSubmapsContradict) {
  Case c = exactCase();  // 10 · 9 numbers of submaps, 10 · 3 + 3 · 2 unknowns: 54 degrees of freedom
  c.joined.objective = 54;
  EXPECT_EQ(describeContradiction(c.submaps, c.joined), "");
  c.joined.objective = 1000;
  c.submaps[4]->features[1].x += 2;
  const auto text = describeContradiction(c.submaps, c.joined);
  EXPECT_THAT(text, HasSubstr("objective 1000 at 54 degrees of freedom"));
  EXPECT_THAT(text, HasSubstr("landmark 2 in submap 4, 2.00 m (20 sigma)"));
  EXPECT_THAT(text, HasSubstr("known_ids = false"));
  c.joined.association_known = false;
  EXPECT_THAT(describeContradiction(c.submaps, c.joined), HasSubstr("matched wrongly"));
  c.joined.status = JoinStatus::kFailed;
  EXPECT_EQ(describeContradiction(c.submaps, c.joined), "");
  EXPECT_EQ(describeContradiction({}, {}), "");
}

}  // namespace
}  // namespace submap_slam
