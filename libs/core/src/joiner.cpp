#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/submap_joiner.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Joiner, mrpt::rtti::CObject, submap_slam)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(SubmapJoiner, submap_slam::Joiner, submap_slam)
IMPLEMENTS_VIRTUAL_MRPT_OBJECT(LandmarkJoiner, submap_slam::Joiner, submap_slam)

namespace submap_slam {
namespace {

class JoinAnew : public IncrementalJoin {
 public:
  explicit JoinAnew(const SubmapJoiner& joiner) : joiner_(joiner) {}

  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) override {
    return joiner_.join(submaps, initial, progress);
  }

 private:
  const SubmapJoiner& joiner_;
};

class JoinLandmarksAnew : public IncrementalLandmarkJoin {
 public:
  explicit JoinLandmarksAnew(const LandmarkJoiner& joiner) : joiner_(joiner) {}

  JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) override {
    return joiner_.join(submaps, progress);
  }

 private:
  const LandmarkJoiner& joiner_;
};

}  // namespace

std::unique_ptr<IncrementalLandmarkJoin> LandmarkJoiner::incremental() const {
  return std::make_unique<JoinLandmarksAnew>(*this);
}

std::unique_ptr<IncrementalJoin> SubmapJoiner::incremental() const {
  return std::make_unique<JoinAnew>(*this);
}

}  // namespace submap_slam
