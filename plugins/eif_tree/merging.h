#pragma once

#include "gauss_newton.h"
#include "known_association.h"

namespace submap_slam::landmark_joining {

/** Merges landmarks that turn out to be one: pairs that no submap holds both of, nearest to each other, whose
 * difference is within the gate of its covariance and more likely than that of two landmarks, as dense as the
 * features of the submaps are: where one is uncertain by more than their spacing, some neighbour always
 * agrees. A round of merges stays only if the objective over all submaps rises by no more than chance allows
 * (jointGate() with two degrees of freedom for each merge); otherwise the nearer half of its pairs is tried.
 * Rounds are repeated until none is left.
 * @param state minimises the objective, and does so afterwards
 * @return number of merges */
std::size_t mergeDuplicates(AssociatedProblem& associated, JointState& state, double gate2,
                            const GaussNewtonOptions& gauss_newton);

}  // namespace submap_slam::landmark_joining
