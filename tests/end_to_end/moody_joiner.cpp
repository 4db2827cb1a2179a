// A joiner that cannot join two submaps and does not like three.
#include <submap_slam/core/submap_joiner.h>

#include <stdexcept>

namespace moody {

class MoodyJoiner : public submap_slam::SubmapJoiner {
  DEFINE_MRPT_OBJECT(MoodyJoiner, moody)

 public:
  std::string name() const override { return "moody"; }
  std::string description() const override { return "fails now and then"; }
  void describe(submap_slam::ParameterTable& table) override { table.section(name(), "Moody"); }
  submap_slam::JoinedMap join(const submap_slam::GridSubmaps& submaps, const submap_slam::JoinedMap& initial,
                              const submap_slam::ProgressCallback& /*progress*/) const override {
    if (submaps.size() == 2) throw std::runtime_error("not these two");
    submap_slam::JoinedMap joined = initial;
    joined.reason = "not in the mood";
    if (submaps.size() == 3) joined.status = submap_slam::JoinStatus::kFailed;
    return joined;
  }
};

}  // namespace moody

IMPLEMENTS_MRPT_OBJECT(MoodyJoiner, submap_slam::SubmapJoiner, moody)
SUBMAP_SLAM_REGISTER_JOINER(registerMoodyJoiner, moody::MoodyJoiner)
SUBMAP_SLAM_PLUGIN()
