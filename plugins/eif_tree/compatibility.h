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
  double gate2 = 9.21;  ///< largest squared distance of a pairing by itself; see jointGate()
};

/** Nearest neighbours: pairings in the order of their distance, each feature and each landmark once. A
 * pairing that contradicts those before it (joint distance above its jointGate()) is left out.
 * @return indices of pairings */
std::vector<std::size_t> nearestNeighbours(const Candidates& candidates);

/** Joint compatibility branch and bound (Neira, Tardós, "Data association in stochastic mapping using the
 * joint compatibility test", 2001): the largest set of pairings that agree with each other, of several the
 * one with the least joint distance. The search ends with the best so far after a fixed number of steps.
 * @return indices of pairings */
std::vector<std::size_t> jointCompatibility(const Candidates& candidates);

/** The set of the joint search where it is larger by half than that of the nearest neighbours, otherwise the
 * latter. Where landmarks stand in rows, a set that is shifted by one of them explains nearly as many, and
 * more at the border of what is known: there the prediction says which is right, not the number.
 * @return indices of pairings */
std::vector<std::size_t> jointUnlessNearestExplain(const Candidates& candidates);

/** The set without pairings that convince neither by themselves nor together: those that are, each by itself,
 * less likely than a new landmark, if the whole set is less likely than the rest with new landmarks in their
 * place. A single landmark near where an uncertain pose expects one closes no loop; several do.
 * @param density of new landmarks (1/m²) */
std::vector<std::size_t> convincing(const Candidates& candidates, const std::vector<std::size_t>& set,
                                    double density);

/** The pairings of a set that no rival disputes. A rival is what agrees with a pairing outside the set, taken
 * greedily by the distance that is left given this one. It disputes the pairings that it does not hold, if
 * these are two or more, it takes at least two thirds of their features for landmarks that are certainly
 * others, and the set is not exp(gate2 / 2) times as likely as the rival, by the joint densities for the
 * features that both pair (with the usual gate 99 % against 1 %). How many features each explains says little
 * where landmarks repeat; see jointUnlessNearestExplain(). A single feature that may be either of two
 * landmarks does not make a place doubtful: it stays with the likelier one.
 * @return indices of pairings, ascending */
std::vector<std::size_t> undisputed(const Candidates& candidates, const std::vector<std::size_t>& set);

/** Largest joint squared distance, with as many degrees of freedom, that is as likely as a distance of
 * `gate2` is with two: the quantile of the χ² distribution for 1 − exp(−gate2 / 2), by Wilson and Hilferty
 * (for 99 % at most 0.2 % off, and the same as `gate2` for two degrees of freedom). */
double jointGate(double gate2, std::size_t degrees_of_freedom);

}  // namespace submap_slam::landmark_joining
