#pragma once

#include <submap_slam/core/landmark_joiner.h>

#include <functional>
#include <string>

#include "joining.h"
#include "unknown_association.h"

namespace submap_slam {

/** Joins landmark submaps in sparse information form: by a binary tree, or one after the other, with a final
 * Gauss-Newton over the original submaps (Combined SLAM; Sparse Local Submap Joining Filter, Huang, Wang,
 * Dissanayake 2008).
 */
class EifTree : public LandmarkJoiner {
  DEFINE_MRPT_OBJECT(EifTree, submap_slam)

 public:
  std::string name() const override { return "eif_tree"; }
  std::string description() const override {
    return "sparse information filter over landmark submaps, by a binary tree or sequentially";
  }
  void describe(ParameterTable& table) override;
  void validate() const override;

  JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const override;

  /** The tree is updated as submaps come; the other methods, and association by position, begin anew. */
  std::unique_ptr<IncrementalLandmarkJoin> incremental() const override;

 private:
  class Incremental;
  bool goesByIds(const LandmarkSubmaps& submaps) const;
  bool hasTree() const { return method_ == "tree_gn" || method_ == "tree"; }
  landmark_joining::JoiningOptions joiningOptions() const;
  JoinedLandmarks joinKnown(const LandmarkSubmaps& submaps,
                            const std::function<bool(double)>& progress) const;
  JoinedLandmarks joinUnknown(const LandmarkSubmaps& submaps,
                              const std::function<bool(double)>& progress) const;

  std::string method_ = "tree_gn";
  landmark_joining::JoiningOptions options_;
  std::string association_ = "known";
  landmark_joining::AssociationOptions association_options_;
};

}  // namespace submap_slam
