// A plugin with a joiner of each form for the tests of the loader.
#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/submap_joiner.h>

namespace sample {

/** Gives back the frames it was given. */
class SampleJoiner : public submap_slam::SubmapJoiner {
  DEFINE_MRPT_OBJECT(SampleJoiner, sample)

 public:
  std::string name() const override { return "sample"; }
  std::string description() const override { return "joins nothing"; }
  void describe(submap_slam::ParameterTable& table) override {
    table.section(name(), "Sample");
    table.add("weight", weight_, "", {0, 1}, "A weight");
  }
  submap_slam::JoinedMap join(const submap_slam::GridSubmaps& /*submaps*/,
                              const submap_slam::JoinedMap& initial,
                              const submap_slam::ProgressCallback& /*progress*/) const override {
    submap_slam::JoinedMap joined = initial;
    joined.objective = weight_;
    return joined;
  }

 private:
  double weight_ = 0.25;
};

/** Puts every submap at the origin. */
class SampleLandmarkJoiner : public submap_slam::LandmarkJoiner {
  DEFINE_MRPT_OBJECT(SampleLandmarkJoiner, sample)

 public:
  std::string name() const override { return "sample_landmarks"; }
  std::string description() const override { return "joins no landmarks"; }
  void describe(submap_slam::ParameterTable& table) override { table.section(name(), "Sample"); }
  submap_slam::JoinedLandmarks join(const submap_slam::LandmarkSubmaps& submaps,
                                    const submap_slam::ProgressCallback& /*progress*/) const override {
    submap_slam::JoinedLandmarks joined;
    joined.frames.resize(submaps.size() + 1);
    return joined;
  }
};

}  // namespace sample

IMPLEMENTS_MRPT_OBJECT(SampleJoiner, submap_slam::SubmapJoiner, sample)
IMPLEMENTS_MRPT_OBJECT(SampleLandmarkJoiner, submap_slam::LandmarkJoiner, sample)
SUBMAP_SLAM_REGISTER_JOINER(registerSampleJoiner, sample::SampleJoiner)
SUBMAP_SLAM_REGISTER_JOINER(registerSampleLandmarkJoiner, sample::SampleLandmarkJoiner)
SUBMAP_SLAM_PLUGIN()
