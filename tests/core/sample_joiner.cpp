// A joiner plugin for the tests of the loader.
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

}  // namespace sample

IMPLEMENTS_MRPT_OBJECT(SampleJoiner, submap_slam::SubmapJoiner, sample)
SUBMAP_SLAM_REGISTER_JOINER(registerSampleJoiner, sample::SampleJoiner)
SUBMAP_SLAM_PLUGIN()
