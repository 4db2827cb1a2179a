#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <map>
#include <tuple>

#include "grid_gauss_newton/full_gauss_newton.h"
#include "grid_gauss_newton/reduced_system.h"
#include "synthetic_submaps.h"

namespace submap_slam::grid_joining {
namespace {

using mrpt::math::TPose2D;

constexpr double kAngle = 0.41;
const auto kEveryJacobian =
    ::testing::Values(JacobianKind::kPaper, JacobianKind::kVariableProjection, JacobianKind::kSurface);

struct Problem {
  GridSubmaps submaps;
  EvidenceLevels level;
  Frames frames;
};

EvidenceLevels finestLevel(const GridSubmaps& submaps, double background = 0) {
  return buildPyramid(submaps, {0, 1, background}).front();
}

template <class Scalar = double>
ReducedSystem reduceAt(const EvidenceLevels& level, const Frames& frames, JacobianKind jacobian,
                       double angle = kAngle) {
  return reduce<Scalar>(PlacedLevels(level, frames, angle), frames, jacobian);
}

/** Four or five submaps that overlap in part; the first and the last hardly do. */
Problem makeProblem(uint32_t seed, bool rough) {
  const std::size_t count = 4 + seed % 2;
  GridSubmaps submaps;
  Frames frames;
  for (std::size_t i = 0; i < count; ++i) {
    const uint32_t s = 10 * seed + static_cast<uint32_t>(i);
    submaps.push_back(rough ? testing::roughSubmap(s, 3.1, 2.3, 0.1)
                            : testing::randomSubmap(s, 3.1, 2.3, 0.1));
    const double k = static_cast<double>(i);
    frames.emplace_back(0.8 * k, 0.3 * std::sin(2.0 * k), 0.5 * k - 0.2);
  }
  return {submaps, finestLevel(submaps), frames};
}

double relativeDifference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).norm() / b.norm();
}

/** Look-up written independently: four weighted cells around a point of the local map frame, unknown outside.
 */
std::pair<double, double> lookUp(const EvidenceGrid& grid, double x, double y) {
  double l = 0, n = 0;
  for (std::size_t r = 0; r < grid.sizeY(); ++r)
    for (std::size_t c = 0; c < grid.sizeX(); ++c) {
      const double u = (x - grid.hits.idx2x(static_cast<int>(c))) / grid.resolution();
      const double v = (y - grid.hits.idx2y(static_cast<int>(r))) / grid.resolution();
      const double weight = std::max(0.0, 1 - std::abs(u)) * std::max(0.0, 1 - std::abs(v));
      if (weight == 0) continue;
      const auto ix = static_cast<unsigned>(c), iy = static_cast<unsigned>(r);
      l += weight * static_cast<double>(*grid.log_odds.cellByIndex(ix, iy));
      n += weight * static_cast<double>(*grid.hits.cellByIndex(ix, iy));
    }
  return {l, n};
}

TEST(ReducedSystem, CostIsThatOfEquation4AtTheBestMap) {
  const Problem p = makeProblem(2, true);
  double cost = 0, weight = 0;
  std::size_t observations = 0;
  for (int a = -30; a < 60; ++a)
    for (int b = -40; b < 40; ++b) {
      const double x = 0.1 * (std::cos(kAngle) * a - std::sin(kAngle) * b);
      const double y = 0.1 * (std::sin(kAngle) * a + std::cos(kAngle) * b);
      std::vector<std::pair<double, double>> seen;
      for (std::size_t i = 0; i < p.frames.size(); ++i) {
        const auto local = p.frames[i].inverseComposePoint({x, y});
        const auto [l, n] = lookUp(p.submaps[i]->evidence, local.x, local.y);
        if (n > 0) seen.emplace_back(l, n);
      }
      if (seen.size() < 2) continue;
      observations += seen.size();
      double n_m = 0, numerator = 0, denominator = 0;
      for (const auto& [l, n] : seen) n_m += n;
      for (const auto& [l, n] : seen) numerator += n / n_m * l, denominator += n / n_m * n / n_m;
      for (const auto& [l, n] : seen) cost += std::pow(n / n_m * numerator / denominator - l, 2);
      for (std::size_t i = 0; i < seen.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          weight += std::pow(seen[i].second * seen[k].second, 2) / (denominator * n_m * n_m);
    }
  const ReducedSystem reduced = reduceAt(p.level, p.frames, JacobianKind::kPaper);
  EXPECT_GT(observations, 2000u);
  EXPECT_EQ(reduced.observations, observations);
  EXPECT_NEAR(reduced.cost, cost, 1e-10 * cost);
  const double all = overlapWeight(PlacedLevels(p.level, p.frames, kAngle), 1);
  EXPECT_NEAR(all, weight, 1e-10 * weight);
  const double sparse = overlapWeight(PlacedLevels(p.level, p.frames, kAngle));
  EXPECT_NEAR(sparse, weight, 0.15 * weight) << "a sixteenth of the lattice points stands for all";
}

class EveryJacobian : public ::testing::TestWithParam<JacobianKind> {};
INSTANTIATE_TEST_SUITE_P(All, EveryJacobian, kEveryJacobian);

TEST_P(EveryJacobian, StepIsThatOfTheFullSystemWhateverTheMap) {
  for (const uint32_t seed : {1u, 2u, 3u}) {
    const Problem p = makeProblem(seed, true);
    const ReducedSystem reduced = reduceAt(p.level, p.frames, GetParam());
    const auto held = anchorsOf(reduced.system);
    const PoseSystem nothing(p.frames.size());
    const auto step = solve(reduced.system, held, Eigen::VectorXd::Zero(3 * held.size()));
    ASSERT_TRUE(step);
    ASSERT_TRUE(held[0]);
    const ExplicitProblem written = writeOut(p.level, p.frames, GetParam(), kAngle);
    const auto explicit_step = poseOnlyStep(written, nothing, held);
    ASSERT_TRUE(explicit_step);
    EXPECT_LT(relativeDifference(*step, *explicit_step), 1e-9);
    for (const double scale : {0.0, 1.0, 100.0}) {
      const Eigen::VectorXd map =
          scale * Eigen::VectorXd::LinSpaced(written.map_jacobian.cols(), -1, 1).array().cos();
      const auto full = fullStep(written, map, nothing, held);
      ASSERT_TRUE(full);
      EXPECT_LT(relativeDifference(*step, full->frames), 1e-9) << "seed " << seed << " scale " << scale;
    }
  }
}

TEST_P(EveryJacobian, PoseTermsEnterAllSolversAlike) {
  const Problem p = makeProblem(4, false);
  ReducedSystem reduced = reduceAt(p.level, p.frames, GetParam());
  const auto held = anchorsOf(reduced.system);
  PoseSystem terms(p.frames.size());
  terms.addBlock(1, 2, Eigen::Vector3d(-3, 2, 1).asDiagonal());
  for (std::size_t i = 0; i < p.frames.size(); ++i)
    terms.addBlock(i, i, Eigen::Vector3d(50, 60, 70).asDiagonal());
  terms.gradient[1] = {5, -4, 3};
  const ExplicitProblem written = writeOut(p.level, p.frames, GetParam(), kAngle);
  const auto full = fullStep(written, Eigen::VectorXd::Zero(written.map_jacobian.cols()), terms, held);
  const auto explicit_step = poseOnlyStep(written, terms, held);
  reduced.system.add(terms, 1);
  const auto step = solve(reduced.system, held, Eigen::VectorXd::Zero(3 * held.size()));
  ASSERT_TRUE(full && explicit_step && step);
  EXPECT_LT(relativeDifference(*step, full->frames), 1e-9);
  EXPECT_LT(relativeDifference(*step, *explicit_step), 1e-9);
}

TEST_P(EveryJacobian, MatrixIsPositiveSemidefinite) {
  const Problem p = makeProblem(5, true);
  const Eigen::MatrixXd matrix = reduceAt(p.level, p.frames, GetParam()).system.denseMatrix();
  EXPECT_EQ((matrix - matrix.transpose()).cwiseAbs().maxCoeff(), 0) << "off-diagonal blocks are stored once";
  for (Eigen::Index i = 0; i < matrix.rows(); i += 3) {
    const Eigen::Matrix3d block = matrix.block<3, 3>(i, i);
    EXPECT_LT((block - block.transpose()).norm(), 1e-12 * block.norm());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
}

void expectSameBits(const ReducedSystem& one, const ReducedSystem& other) {
  EXPECT_EQ(one.cost, other.cost);
  EXPECT_EQ(one.energy, other.energy);
  EXPECT_EQ(one.observations, other.observations);
  EXPECT_EQ(one.system.denseMatrix(), other.system.denseMatrix());
  EXPECT_EQ(one.system.denseGradient(), other.system.denseGradient());
}

TEST_P(EveryJacobian, SameBitsForAnyNumberOfThreads) {
  const Problem p = makeProblem(3, true);
  const auto with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return reduceAt(p.level, p.frames, GetParam());
  };
  const ReducedSystem one = with(1);
  for (int again = 0; again < 2; ++again) expectSameBits(one, with(2));
}

/** On a machine without AVX-512, or without AVX2, the wider loops are not compared. */
TEST_P(EveryJacobian, SameBitsWithEveryInstructionSet) {
  const Problem p = makeProblem(3, true);
  const PlacedLevels placed(p.level, p.frames, kAngle);
  const auto single = reduce<float>(placed, p.frames, GetParam(), InstructionSet::kBaseline);
  const auto twice = reduce<double>(placed, p.frames, GetParam(), InstructionSet::kBaseline);
  EXPECT_GT(single.observations, 1000u);
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!isSupported(set)) continue;
    expectSameBits(single, reduce<float>(placed, p.frames, GetParam(), set));
    expectSameBits(twice, reduce<double>(placed, p.frames, GetParam(), set));
  }
}

TEST(ReducedSystem, VariableProjectionIsTheGradientOfTheCost) {
  const Problem p = makeProblem(6, false);
  const Eigen::VectorXd gradient =
      2 * reduceAt(p.level, p.frames, JacobianKind::kVariableProjection).system.denseGradient();
  const double h = 1e-7;
  Eigen::VectorXd differences(gradient.size());
  for (Eigen::Index k = 0; k < gradient.size(); ++k) {
    const auto costAt = [&](double offset) {
      Eigen::VectorXd step = Eigen::VectorXd::Zero(gradient.size());
      step[k] = offset;
      return reduceAt(p.level, moved(p.frames, step), JacobianKind::kPaper).cost;
    };
    differences[k] = (costAt(h) - costAt(-h)) / (2 * h);
  }
  EXPECT_LT(relativeDifference(gradient, differences), 1e-6);
  const Eigen::VectorXd paper = 2 * reduceAt(p.level, p.frames, JacobianKind::kPaper).system.denseGradient();
  EXPECT_GT(relativeDifference(paper, differences), 1e-3) << "the published form leaves the hit counts out";
}

TEST(ReducedSystem, SurfaceJacobianVanishesInUniformSpace) {
  GridSubmaps submaps;
  for (int i = 0; i < 2; ++i) {
    submaps.push_back(testing::randomSubmap(static_cast<uint32_t>(i), 3, 3, 0.1));
    EvidenceGrid& grid = submaps.back()->evidence;
    for (std::size_t k = 0; k < grid.cells(); ++k)
      grid.log_odds.begin()[static_cast<std::ptrdiff_t>(k)] = -2 * grid.hits.data()[k];
  }
  const Frames frames{{0, 0, 0}, {0.4, -0.3, 0.6}};
  const ReducedSystem reduced = reduceAt(finestLevel(submaps), frames, JacobianKind::kSurface);
  EXPECT_GT(reduced.observations, 500u);
  EXPECT_LT(reduced.cost, 1e-20 * reduced.energy);
  EXPECT_LT(reduced.system.denseMatrix().cwiseAbs().maxCoeff(), 1e-20 * reduced.energy);

  const double background = backgroundOf(submaps);
  EXPECT_FLOAT_EQ(static_cast<float>(background), -2.0f);
  const ReducedSystem nothing = reduceAt(finestLevel(submaps, background), frames, JacobianKind::kSurface);
  EXPECT_EQ(nothing.cells, 0u) << "uniform space needs no work when the background is taken off";
  EXPECT_TRUE(nothing.system.blocks.empty());
}

/** L ← L − b N leaves cost and normal equations as they are, with the Jacobians that know of N. */
TEST(ReducedSystem, BackgroundChangesNothing) {
  GridSubmaps submaps;
  const Frames frames{{0, 0, 0}, {1.5, 0.6, 0.7}, {-1.2, 0.9, -0.4}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    submaps.push_back(testing::renderSubmap(testing::room(), frames[i], 4, 0.1));
    EvidenceGrid& grid = submaps.back()->evidence;  // free space at exactly -1 per hit
    for (std::size_t k = 0; k < grid.cells(); ++k) {
      float& log_odds = grid.log_odds.begin()[static_cast<std::ptrdiff_t>(k)];
      log_odds = std::max(log_odds, -0.9f * grid.hits.data()[k]) - 0.1f * grid.hits.data()[k];
    }
  }
  const double background = backgroundOf(submaps);
  EXPECT_NEAR(background, -1, 1e-5);
  const Frames off{{0, 0, 0}, {1.55, 0.57, 0.71}, {-1.18, 0.96, -0.42}};
  for (const JacobianKind jacobian : {JacobianKind::kVariableProjection, JacobianKind::kSurface}) {
    const ReducedSystem plain = reduceAt(finestLevel(submaps), off, jacobian);
    const ReducedSystem above = reduceAt(finestLevel(submaps, background), off, jacobian);
    EXPECT_LT(above.cells, plain.cells / 2) << "free space is left out";
    EXPECT_NEAR(above.cost, plain.cost, 1e-4 * plain.cost);
    const Eigen::MatrixXd a = above.system.denseMatrix(), b = plain.system.denseMatrix();
    EXPECT_LT((a - b).norm(), 1e-3 * b.norm());
    EXPECT_LT(relativeDifference(above.system.denseGradient(), plain.system.denseGradient()), 1e-3);
  }
}

/** Look-ups are exact to about 1e-6 of a cell and sums over the 256 cells of a tile to about 1e-6. */
TEST_P(EveryJacobian, SinglePrecisionAgreesWithDouble) {
  const Problem p = makeProblem(4, false);
  const ReducedSystem single = reduceAt<float>(p.level, p.frames, GetParam());
  const ReducedSystem twice = reduceAt(p.level, p.frames, GetParam());
  EXPECT_NEAR(single.cost, twice.cost, 1e-5 * twice.cost);
  const Eigen::MatrixXd a = single.system.denseMatrix(), b = twice.system.denseMatrix();
  EXPECT_LT((a - b).norm(), 1e-4 * b.norm());
  EXPECT_LT(relativeDifference(single.system.denseGradient(), twice.system.denseGradient()), 1e-4);
}

/** All frames moved rigidly, so that the lattice falls on the same points of every submap again. */
TEST(ReducedSystem, RigidMotionOfEverythingChangesNothing) {
  const Problem p = makeProblem(7, true);
  const ReducedSystem here = reduceAt(p.level, p.frames, JacobianKind::kPaper);
  const double a = 37, b = -12, turn = 0.83;
  const TPose2D shift(0.1 * (std::cos(kAngle) * a - std::sin(kAngle) * b),
                      0.1 * (std::sin(kAngle) * a + std::cos(kAngle) * b), 0);
  Frames shifted, turned;
  for (const TPose2D& frame : p.frames) {
    shifted.push_back(shift + frame);
    turned.push_back(TPose2D(0, 0, turn) + frame);
  }
  const ReducedSystem there = reduceAt(p.level, shifted, JacobianKind::kPaper);
  const ReducedSystem round = reduceAt(p.level, turned, JacobianKind::kPaper, kAngle + turn);
  EXPECT_NEAR(there.cost, here.cost, 1e-9 * here.cost);
  EXPECT_NEAR(round.cost, here.cost, 1e-9 * here.cost);
}

TEST(ReducedSystem, CellsOfOneSubmapCountForNothing) {
  const EvidenceLevels level =
      finestLevel({testing::roughSubmap(1, 3, 2, 0.1), testing::roughSubmap(2, 3, 2, 0.1)});
  const ReducedSystem alone = reduceAt({level[0]}, {{0.3, 0.2, 0.1}}, JacobianKind::kPaper);
  const ReducedSystem apart = reduceAt(level, {{0, 0, 0}, {3.5, 2.5, 0.3}}, JacobianKind::kPaper);
  for (const ReducedSystem& none : {alone, apart}) {
    EXPECT_EQ(none.observations, 0u);
    EXPECT_EQ(none.cost, 0);
    EXPECT_TRUE(none.system.blocks.empty());
  }
}

TEST(ReducedSystem, SubmapWithoutEvidenceIsHarmless) {
  GridSubmaps submaps{testing::roughSubmap(1, 3, 2, 0.1), GridSubmap::Create(),
                      testing::roughSubmap(2, 3, 2, 0.1)};
  submaps[1]->evidence = EvidenceGrid(-1, 1, -1, 1, 0.1);
  const EvidenceLevels all = finestLevel(submaps);
  const EvidenceLevels two{all[0], all[2]};
  const TPose2D first(0, 0, 0), last(0.5, 0.4, 0.3);
  const ReducedSystem with = reduceAt(all, {first, {0.1, 0, 0}, last}, JacobianKind::kPaper);
  const ReducedSystem without = reduceAt(two, {first, last}, JacobianKind::kPaper);
  EXPECT_GT(without.observations, 0u);
  EXPECT_EQ(with.observations, without.observations);
  EXPECT_EQ(with.cost, without.cost);
  EXPECT_EQ(with.system.gradient[1], Eigen::Vector3d::Zero());
}

TEST(Anchors, OneForEachConnectedGroup) {
  PoseSystem system(5);
  for (std::size_t i = 0; i < 5; ++i) system.addBlock(i, i, Eigen::Matrix3d::Identity());
  system.addBlock(0, 3, Eigen::Matrix3d::Identity());
  system.addBlock(4, 1, Eigen::Matrix3d::Identity());
  system.addBlock(1, 2, Eigen::Matrix3d::Zero());
  EXPECT_EQ(anchorsOf(system), (std::vector<bool>{true, true, true, false, false}));
  EXPECT_EQ(groupsOf(system), (std::vector<std::size_t>{0, 1, 2, 0, 1}));
}

TEST(PoseSystem, MarginalCovarianceIsTheBlockOfTheInverse) {
  const Problem p = makeProblem(8, true);
  const PoseSystem system = reduceAt(p.level, p.frames, JacobianKind::kVariableProjection).system;
  const auto covariances =
      marginalCovariances(system, anchorsOf(system), Eigen::VectorXd::Zero(3 * p.frames.size()));
  ASSERT_TRUE(covariances);
  const Eigen::Index free = 3 * static_cast<Eigen::Index>(p.frames.size()) - 3;
  const Eigen::MatrixXd inverse = system.denseMatrix().bottomRightCorner(free, free).inverse();
  EXPECT_EQ(covariances->front(), Eigen::Matrix3d::Zero());
  for (std::size_t i = 1; i < p.frames.size(); ++i) {
    const Eigen::Index k = 3 * static_cast<Eigen::Index>(i) - 3;
    const Eigen::Matrix3d expected = inverse.block<3, 3>(k, k);
    EXPECT_LT(((*covariances)[i] - expected).norm(), 1e-9 * expected.norm());
  }
}

}  // namespace
}  // namespace submap_slam::grid_joining
