#include "loop_search.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

#include <submap_slam/core/doubtful_ends.h>
#include <submap_slam/core/relative_pose.h>
#include "frame_covariances.h"

namespace submap_slam::pose_graph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using mrpt::math::TPose2D;

/** Quantiles of χ² with 3 and 6 degrees of freedom that a true match stays below (0.999 and 0.9997). */
constexpr double kChi2Alone = 16, kChi2Together = 25;

/** Standard deviations of what lies beyond a gap in the log: it may be anywhere. */
constexpr double kGap_m = 100, kGap_rad = 3;

/** With a larger standard deviation a heading is not known at all: the robot was carried. */
constexpr double kHeadingUnknown_rad = 0.9;

/** A relation with a larger standard deviation is hardly known: matches in it agree with nearly everything.
 */
constexpr double kHardlyKnown_m = 2;

/** Two such matches bear each other out only if knowing one shrinks the volume of where the other may be to
 * this share. */
constexpr double kTellsMuch = 0.1;

bool isHardlyKnown(const Matrix3d& covariance) {
  return std::max(covariance(0, 0), covariance(1, 1)) > kHardlyKnown_m * kHardlyKnown_m;
}

/** Odometry's idea of T_s_end, if the log has odometry at both ends. */
std::optional<TPose2D> odometryOfEnd(const GridSubmap& submap, const GridSubmap& next) {
  if (submap.nodes.empty() || next.nodes.empty()) return std::nullopt;
  const auto &from = submap.nodes.front().odometry, &to = next.nodes.front().odometry;
  if (!from || !to) return std::nullopt;
  return *to - *from;
}

/** Of consecutive submaps. */
Link chainLink(const GridSubmaps& submaps, std::size_t k, const LoopSearchParams& params) {
  const GridSubmap &submap = *submaps[k], &next = *submaps[k + 1];
  const ChainNoise& noise = params.chain;
  const Matrix3d end = submap.end_pose.cov.asEigen();
  Link link{k, k + 1, submap.end_pose.mean.asTPose(), end, end, false};
  if (!submap.has_successor) {
    link.covariance += variances(kGap_m, kGap_rad);
    link.usual_covariance = link.covariance;
    return link;
  }
  const double path = std::max(1.0, submap.pathLength());
  link.usual_covariance += variances(noise.usual_xy_per_m, noise.usual_phi_per_m) * path;
  Vector3d variance(noise.sigma_xy_per_m * noise.sigma_xy_per_m * path, 0,
                    noise.sigma_phi_per_m * noise.sigma_phi_per_m * path);
  if (const auto odometry = odometryOfEnd(submap, next)) {
    const TPose2D off = *odometry - link.T_a_b;
    const double xy = std::min(noise.max_xy, noise.odometry_share * std::hypot(off.x, off.y));
    const double phi = std::min(noise.max_phi, noise.odometry_share * std::abs(off.phi));
    variance += Vector3d(xy * xy, 0, phi * phi);
  }
  variance.y() = variance.x();
  link.covariance.diagonal() += variance;
  return link;
}

/** Of a match, by its information alone: the rest is for whoever believes it. */
Matrix3d covarianceOf(const SubmapMatch& match) {
  Matrix3d information = match.information;
  information.diagonal().array() += 1;  // along a corridor: 1 m, 1 rad
  // The information is of the map frame's axes; the relation's are those of T_ref too: no turn.
  return information.inverse();
}

/** Where the robot was in a submap: a circle around its path, in the local map frame. */
struct PathCircle {
  double x = 0, y = 0, radius = 0;  ///< m

  explicit PathCircle(const GridSubmap& submap) {
    if (submap.nodes.empty()) return;
    for (const auto& node : submap.nodes) x += node.pose.x, y += node.pose.y;
    x /= static_cast<double>(submap.nodes.size());
    y /= static_cast<double>(submap.nodes.size());
    for (const auto& node : submap.nodes)
      radius = std::max(radius, std::hypot(node.pose.x - x, node.pose.y - y));
  }
};

/** A match that passed the gates and waits for another one to bear it out. */
struct Pending {
  Link link;
  double window = 0;      ///< m
  std::size_t entry = 0;  ///< in the list of candidates
};

}  // namespace

/** A search at some submap. */
class LoopSearch::State {
 public:
  explicit State(const LoopSearchParams& params) : params_(params) {}

  LoopSearchResult search(const GridSubmaps& submaps, const std::function<bool(double)>& progress,
                          const HandEdits& by_hand);
  const std::vector<TPose2D>& frames() const { return result_.graph.frames; }

 private:
  struct Task {
    std::size_t older;
    PoseWindow window;  ///< of T_k_older
    Matrix3d covariance;
    std::optional<SubmapMatch> match;
    Matrix3d match_covariance = Matrix3d::Zero();
    std::string refused;  ///< why, or empty
  };

  void appendFrame(FrameGraph& graph) const;
  void closeLoops(std::size_t k);
  std::vector<Task> tasksOf(std::size_t k, const FrameCovariances& covariances) const;
  SubmapMatcherParams matcherParams(const std::vector<Task>& tasks) const;
  void attempt(std::size_t k, const SubmapMatcher& matcher, Task& task) const;
  std::string refusal(std::size_t k, const SubmapMatcher& matcher, const Task& task) const;
  std::size_t list(std::size_t k, const Task& task, const Matrix3d& covariance);
  bool acceptVerified(std::size_t k, const FrameCovariances& covariances);
  enum class Agreement { kAgree, kContradict, kTellNothing };
  Agreement compare(const Link& a, const Link& b, const FrameCovariances& covariances) const;
  void accept(const Pending& pending, const std::string& reason);

  const LoopSearchParams params_;
  GridSubmaps submaps_;
  HandEdits by_hand_;
  LoopSearchResult result_;             // of the submaps that are known
  std::vector<PathCircle> paths_;       // of those and the one under way
  std::vector<MatchableSubmap> known_;  // submaps that were searched
  std::vector<Pending> pending_;
};

LoopSearchResult LoopSearch::State::search(const GridSubmaps& submaps,
                                           const std::function<bool(double)>& progress,
                                           const HandEdits& by_hand) {
  submaps_ = submaps;
  by_hand_ = by_hand;
  bool go_on = true;
  while (go_on && known_.size() < submaps.size()) {
    appendFrame(result_.graph);
    closeLoops(known_.size());
    go_on = !progress || progress(static_cast<double>(known_.size()) / static_cast<double>(submaps.size()));
  }
  LoopSearchResult result = result_;
  result.stopped = known_.size() < submaps.size();
  while (result.graph.frames.size() < submaps.size()) appendFrame(result.graph);
  return result;
}

/** The frame of the next submap, where the chain has it, with the links by hand whose newer end it is. */
void LoopSearch::State::appendFrame(FrameGraph& graph) const {
  const std::size_t k = graph.frames.size();
  if (k == 0) {
    graph.frames.push_back({});
    return;
  }
  const Link link = chainLink(submaps_, k - 1, params_);
  graph.frames.push_back(graph.frames.back() + link.T_a_b);
  graph.links.push_back(link);
  const std::size_t before = graph.links.size();
  for (const Link& by_hand : by_hand_.links)
    if (std::max(by_hand.from, by_hand.to) == k) graph.links.push_back(by_hand);
  if (graph.links.size() > before) graph.optimise();
}

void LoopSearch::State::closeLoops(std::size_t k) {
  paths_.emplace_back(*submaps_[k]);
  const FrameCovariances covariances(result_.graph);
  std::vector<Task> tasks = tasksOf(k, covariances);
  if (tasks.empty()) {
    known_.push_back(matchable(*submaps_[k], params_.matcher));
    return;
  }
  const SubmapMatcher matcher(*submaps_[k], matcherParams(tasks));
  known_.push_back(matcher.reference());
  tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t t) { attempt(k, matcher, tasks[t]); });
  for (const Task& task : tasks) {
    if (!task.match) continue;
    const Matrix3d usual =
        covarianceOf(*task.match) + variances(params_.usual_match_xy, params_.usual_match_phi);
    const std::size_t entry = list(k, task, usual);
    if (!task.refused.empty()) continue;
    pending_.push_back({{k, task.older, task.match->T_ref_other, task.match_covariance, usual, true},
                        task.window.half_xy,
                        entry});
  }
  if (acceptVerified(k, covariances)) result_.graph.optimise();
}

/** With the levels that the widest window needs. */
SubmapMatcherParams LoopSearch::State::matcherParams(const std::vector<Task>& tasks) const {
  SubmapMatcherParams params = params_.matcher;
  double widest = 0;
  for (const Task& task : tasks) widest = std::max(widest, task.window.half_xy);
  params.pyramid.levels = std::min(params.pyramid.levels, usefulLevels(widest, params.pyramid.resolution));
  return params;
}

std::vector<LoopSearch::State::Task> LoopSearch::State::tasksOf(std::size_t k,
                                                                const FrameCovariances& covariances) const {
  std::vector<Task> tasks;
  const auto& frames = result_.graph.frames;
  for (std::size_t i = 0; i < k; ++i) {
    if (i + 1 == k && !endIsDoubtful(*submaps_[i])) continue;
    const TPose2D T_k_i = frames[i] - frames[k];
    const PathCircle &here = paths_[k], &there = paths_[i];
    const mrpt::math::TPoint2D centre = T_k_i.composePoint({there.x, there.y});
    const double apart =
        std::hypot(centre.x - here.x, centre.y - here.y) - here.radius - there.radius - params_.sight;
    if (apart > params_.max_window) continue;
    const Matrix3d covariance = covariances.relative({k, i});
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance.topLeftCorner<2, 2>());
    const double sigma_xy = std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
    const double sigma_phi = std::sqrt(std::max(0.0, covariance(2, 2)));
    PoseWindow window{T_k_i, std::min(params_.max_window, params_.margin_xy + 3 * sigma_xy),
                      std::min(params_.max_window_phi, params_.margin_phi + 3 * sigma_phi)};
    if (sigma_phi > kHeadingUnknown_rad) window.half_phi = M_PI;
    if (sigma_xy < params_.known || apart > window.half_xy) continue;
    tasks.push_back({i, window, covariance, std::nullopt, Matrix3d::Zero(), {}});
  }
  return tasks;
}

void LoopSearch::State::attempt(std::size_t k, const SubmapMatcher& matcher, Task& task) const {
  task.match = matcher.match(known_[task.older], task.window);
  if (!task.match) return;
  task.match_covariance =
      covarianceOf(*task.match) + variances(params_.match_sigma_xy, params_.match_sigma_phi);
  task.refused = refusal(k, matcher, task);
}

std::string LoopSearch::State::refusal(std::size_t k, const SubmapMatcher& matcher, const Task& task) const {
  const SubmapMatch& match = *task.match;
  if (by_hand_.refuses(k, task.older)) return "rejected by hand";
  if (match.hit_share < params_.min_hit_share)
    return fmt::format("overlap too small: {:.2f} of the surfaces", match.hit_share);
  if (match.agreement < params_.min_agreement)
    return fmt::format("contradicts free space: agreement {:.2f}", match.agreement);
  // Linearised, a covariance says nothing of where the older frame is if the heading may be any.
  if (task.covariance(2, 2) <= kHeadingUnknown_rad * kHeadingUnknown_rad) {
    const Vector3d e = relationError({}, match.T_ref_other, task.window.centre).e;
    const double chi2 = e.dot((task.covariance + task.match_covariance).inverse() * e);
    if (chi2 > kChi2Alone) return fmt::format("too far from where the chain leads: chi2 {:.0f}", chi2);
  }
  if (task.window.half_xy <= params_.rival_window) return {};
  const double rival = matcher.rivalScore(known_[task.older], task.window, match);
  if (rival > 0)
    return fmt::format("ambiguous: scores {:.2f} here, {:.2f} elsewhere", match.searched.score, rival);
  return {};
}

std::size_t LoopSearch::State::list(std::size_t k, const Task& task, const Matrix3d& covariance) {
  Constraint candidate;
  candidate.from = submaps_[k]->id;
  candidate.to = submaps_[task.older]->id;
  candidate.T_a_b.mean = mrpt::poses::CPose2D(task.match->T_ref_other);
  candidate.T_a_b.cov.asEigen() = covariance;
  candidate.inter = true;
  candidate.accepted = false;
  candidate.by_hand = by_hand_.refuses(k, task.older);
  candidate.reason = task.refused.empty() ? "no other match bears it out" : task.refused;
  result_.candidates.push_back(candidate);
  return result_.candidates.size() - 1;
}

LoopSearch::State::Agreement LoopSearch::State::compare(const Link& a, const Link& b,
                                                        const FrameCovariances& covariances) const {
  const FrameCovariances::Pair pa{a.from, a.to}, pb{b.from, b.to};
  const auto& frames = result_.graph.frames;
  Eigen::Matrix<double, 6, 1> e;
  e << relationError(frames[a.from], frames[a.to], a.T_a_b).e,
      relationError(frames[b.from], frames[b.to], b.T_a_b).e;
  Eigen::Matrix<double, 6, 6> S;
  S.topLeftCorner<3, 3>() = covariances.relative(pa) + a.covariance;
  S.bottomRightCorner<3, 3>() = covariances.relative(pb) + b.covariance;
  S.topRightCorner<3, 3>() = covariances.crossed(pa, pb);
  S.bottomLeftCorner<3, 3>() = S.topRightCorner<3, 3>().transpose();
  const Matrix3d A = S.topLeftCorner<3, 3>(), B = S.bottomRightCorner<3, 3>();
  const double apart = std::sqrt(A.determinant() * B.determinant());
  const bool tells = std::sqrt(std::max(0.0, S.determinant())) < kTellsMuch * apart;
  if ((isHardlyKnown(A) || isHardlyKnown(B)) && !tells) return Agreement::kTellNothing;
  return e.dot(S.ldlt().solve(e)) < kChi2Together ? Agreement::kAgree : Agreement::kContradict;
}

void LoopSearch::State::accept(const Pending& pending, const std::string& reason) {
  result_.graph.links.push_back(pending.link);
  Constraint& entry = result_.candidates[pending.entry];
  entry.accepted = true;
  entry.reason = reason;
}

bool LoopSearch::State::acceptVerified(std::size_t k, const FrameCovariances& covariances) {
  const auto isOld = [&](const Pending& p) {
    return p.link.from + static_cast<std::size_t>(params_.witnesses_from) <= k;
  };
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), isOld), pending_.end());
  std::vector<std::string> reasons(pending_.size());
  for (std::size_t p = 0; p < pending_.size(); ++p) {
    if (pending_[p].window <= params_.lone_window) reasons[p] = "matched where it was expected";
    for (std::size_t q = 0; q < p; ++q) {
      const Link &a = pending_[p].link, &b = pending_[q].link;
      if (a.from == b.from || compare(a, b, covariances) != Agreement::kAgree) continue;
      const auto because = [this](const Link& other) {
        return fmt::format("agrees with {} to {}", submaps_[other.from]->id, submaps_[other.to]->id);
      };
      if (reasons[p].empty()) reasons[p] = because(b);
      if (reasons[q].empty()) reasons[q] = because(a);
    }
  }
  // In places that look alike several groups of matches may each agree among themselves: then none is
  // believed.
  std::vector<bool> contradicted(pending_.size(), false);
  for (std::size_t p = 0; p < pending_.size(); ++p)
    for (std::size_t q = 0; q < p; ++q) {
      const Link &a = pending_[p].link, &b = pending_[q].link;
      const bool both = !reasons[p].empty() && !reasons[q].empty();
      const bool same_older = a.from == b.from && a.to == b.to;
      if (!both || same_older || pending_[p].window <= params_.lone_window) continue;
      if (!isHardlyKnown(covariances.relative({a.from, a.to})) ||
          !isHardlyKnown(covariances.relative({b.from, b.to})) ||
          compare(a, b, covariances) != Agreement::kContradict)
        continue;
      contradicted[p] = contradicted[q] = true;
    }
  for (std::size_t p = 0; p < pending_.size(); ++p)
    if (contradicted[p]) {
      reasons[p].clear();
      result_.candidates[pending_[p].entry].reason = "contradicted by matches as good elsewhere";
    }
  bool any = false;
  std::vector<Pending> waiting;
  for (std::size_t p = 0; p < pending_.size(); ++p) {
    if (reasons[p].empty()) {
      waiting.push_back(pending_[p]);
      continue;
    }
    accept(pending_[p], reasons[p]);
    any = true;
  }
  pending_ = std::move(waiting);
  return any;
}

LoopSearch::LoopSearch(const LoopSearchParams& params) : state_(std::make_unique<State>(params)) {}
LoopSearch::~LoopSearch() = default;

LoopSearchResult LoopSearch::search(const GridSubmaps& submaps, const std::function<bool(double)>& progress,
                                    const HandEdits& by_hand) {
  return state_->search(submaps, progress, by_hand);
}

const std::vector<TPose2D>& LoopSearch::frames() const { return state_->frames(); }

}  // namespace submap_slam::pose_graph
