#pragma once

#include <functional>
#include <string>

#include "covariances.h"
#include "gauss_newton.h"
#include "tree.h"

namespace submap_slam::landmark_joining {

enum class Method {
  kTreeThenGaussNewton,
  kTree,
  kSequential,          ///< SLSJF
  kSequentialIterated,  ///< I-SLSJF
  kDenseFilter          ///< extended Kalman filter
};

struct JoiningOptions {
  Method method = Method::kTreeThenGaussNewton;
  int steps_per_join = 1;           ///< of the tree
  double relinearise_above = 0.01;  ///< of the iterated sequential filter (m, rad)
  GaussNewtonOptions gauss_newton;
};

/** An estimate with its covariances; without any joining where the status is kFailed. */
struct Joining {
  JointState state;
  Covariances covariances;
  GaussNewtonResult result;
};

/** Joins by the method that the options say.
 * @param progress may be empty; called with the share of the work done, false ends it early with
 * what was joined so far */
Joining joinBy(const JoiningOptions& options, const JointProblem& problem,
               const std::function<bool(double)>& progress);

/** Joins by a tree that goes on from the call before; see JoiningTree for `ids`. The method must be one with
 * a tree. */
Joining joinByTree(JoiningTree& tree, const std::vector<uint32_t>& ids, const JoiningOptions& options,
                   const JointProblem& problem, const std::function<bool(double)>& progress);

/** A tree for the options. */
JoiningTree treeFor(const JoiningOptions& options);

/** Gauss-Newton over all submaps from a given state. */
Joining joinFrom(JointState start, const JointProblem& problem, const GaussNewtonOptions& options,
                 const std::function<bool(double)>& progress);

}  // namespace submap_slam::landmark_joining
