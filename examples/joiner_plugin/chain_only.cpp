// A joiner that joins nothing: it chains the end poses and fuses the evidence. Start your own from it.
#include <submap_slam/core/errors.h>
#include <submap_slam/core/submap_joiner.h>

namespace example {

/** Frames from the chain of end poses, whatever the joiners before it found: the baseline that a real joiner
 * must beat. */
class ChainOnly : public submap_slam::SubmapJoiner {
  DEFINE_MRPT_OBJECT(ChainOnly, example)

 public:
  std::string name() const override { return "chain_only"; }

  std::string description() const override { return "keeps the chain of end poses (example)"; }

  void describe(submap_slam::ParameterTable& table) override {
    table.section(name(), "Chaining without optimisation");
    table.add("resolution", resolution_, "m", {0.0, 10.0},
              "Cell size of the global map; 0: that of the submaps.");
  }

  void validate() const override {
    constexpr double kFinest = 0.001;
    if (resolution_ > 0 && resolution_ < kFinest)
      throw submap_slam::ConfigError("[chain_only] resolution: 0 or at least 0.001 m expected");
  }

  submap_slam::JoinedMap join(const submap_slam::GridSubmaps& submaps,
                              const submap_slam::JoinedMap& /*initial*/,
                              const submap_slam::ProgressCallback& progress) const override {
    submap_slam::JoinedMap joined = submap_slam::chainSubmaps(submaps);
    joined.status = submap_slam::JoinStatus::kChained;
    joined.reason = "chain of end poses";
    joined.map = submap_slam::fuseEvidence(submaps, joined.frames, resolution_);
    if (progress) progress(1.0, "chained");
    return joined;
  }

 private:
  double resolution_ = 0;  ///< m per cell; 0: that of the finest submap
};

}  // namespace example

IMPLEMENTS_MRPT_OBJECT(ChainOnly, submap_slam::SubmapJoiner, example)
SUBMAP_SLAM_REGISTER_JOINER(registerChainOnly, example::ChainOnly)
SUBMAP_SLAM_PLUGIN()
