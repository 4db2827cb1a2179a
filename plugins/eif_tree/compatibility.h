#pragma once

#include <Eigen/Core>
#include <vector>

namespace submap_slam::landmark_joining {

/** A feature of a submap and a landmark that it may be. */
struct Pairing {
  int feature = 0, landmark = 0;
  double distance2 = 0;  ///< squared Mahalanobis distance
};

/** All pairings that may be, with their joint innovation: two rows for each pairing. */
struct Candidates {
  std::vector<Pairing> pairings;
  Eigen::VectorXd innovation;
  Eigen::MatrixXd covariance;
};

/** Nearest neighbours: pairings in the order of their distance, each feature and each landmark once. A
 * pairing that contradicts those before it (joint distance above the 99 % quantile) is left out.
 * @return indices of pairings */
std::vector<std::size_t> nearestNeighbours(const Candidates& candidates);

/** Joint compatibility branch and bound (Neira, Tardós, "Data association in stochastic mapping using the
 * joint compatibility test", 2001): the largest set of pairings that agree with each other, of several the
 * one with the least joint distance. The search ends with the best so far after a fixed number of steps.
 * @return indices of pairings */
std::vector<std::size_t> jointCompatibility(const Candidates& candidates);

/** 99 % quantile of the χ² distribution, by Wilson and Hilferty (0.1 % off for two degrees of freedom, less
 * for more). */
double gate(std::size_t degrees_of_freedom);

}  // namespace submap_slam::landmark_joining
