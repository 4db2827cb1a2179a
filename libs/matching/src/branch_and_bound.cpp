#include <submap_slam/matching/branch_and_bound.h>

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** Of a point on an occupied cell. */
constexpr uint32_t kBestScore = 255;

struct Cell {
  int column, row;
};

/** 2^level × 2^level offsets (cells) and 2^turnLevel() headings (steps). */
struct Branch {
  uint32_t sum = 0;  ///< upper bound of the points' scores
  int turn = 0, dx = 0, dy = 0;
  int level = 0;

  /** Several headings at once blur the bound, which is not worth it where few offsets are left. */
  int turnLevel() const { return level < 2 ? 0 : level; }
};

bool isBetter(const Branch& a, const Branch& b) {
  return std::tie(b.sum, a.turn, a.dx, a.dy) < std::tie(a.sum, b.turn, b.dx, b.dy);
}

double farthest(const std::vector<TPoint2D>& points) {
  double r2 = 0;
  for (const auto& p : points) r2 = std::max(r2, p.sqrNorm());
  return std::sqrt(r2);
}

/** One search of a window. Offsets and headings run from 0; the window's centre is in their middle. */
class WindowSearch {
 public:
  WindowSearch(const ScorePyramid& map, const std::vector<TPoint2D>& points, const PoseWindow& window);

  /** The best leaf that has at least `least` and that `counts` accepts; level < 0: none. */
  template <class Counts>
  Branch best(uint32_t least, const Counts& counts);

  TPose2D poseOf(const Branch& leaf) const;

 private:
  double headingOf(double turn) const { return window_.centre.phi + (turn - half_turns_) * turn_step_; }
  const std::vector<Cell>& cellsAt(int turn_level, int turn);
  struct LookUp {
    const ScorePyramid::Level& level;
    const std::vector<Cell>& cells;
    int dx, dy;
  };
  LookUp lookUpOf(const Branch& branch);
  uint32_t bound(const Branch& branch);
  std::array<uint32_t, 4> fourBounds(const Branch& branch, uint32_t least);
  bool isInside(const Branch& branch) const {
    return branch.dx <= 2 * half_cells_ && branch.dy <= 2 * half_cells_ && branch.turn <= 2 * half_turns_;
  }
  template <class Counts>
  void descend(const std::vector<Branch>& branches, Branch& best, uint32_t& least, const Counts& counts);
  std::vector<Branch> partsOf(const Branch& branch, uint32_t least);

  const ScorePyramid& map_;
  const std::vector<TPoint2D>& points_;
  PoseWindow window_;
  int half_cells_, half_turns_, top_level_ = 0;
  double turn_step_;
  std::vector<std::vector<std::vector<Cell>>> cells_;  ///< by turn level and heading, computed when needed
  std::vector<Branch> roots_;
};

WindowSearch::WindowSearch(const ScorePyramid& map, const std::vector<TPoint2D>& points,
                           const PoseWindow& window)
    : map_(map), points_(points), window_(window) {
  half_cells_ = static_cast<int>(std::ceil(window.half_xy / map.resolution()));
  const double step = map.resolution() / std::max(farthest(points), map.resolution());
  half_turns_ = static_cast<int>(std::ceil(window.half_phi / step));
  turn_step_ = half_turns_ > 0 ? window.half_phi / half_turns_ : 0;

  // A branch of one level is bounded by the scores of the next one.
  while (top_level_ + 2 < map.levels() && (2 << top_level_) <= 2 * half_cells_ + 1) ++top_level_;
  cells_.resize(static_cast<std::size_t>(top_level_ + 1));
  for (int level = 0; level <= top_level_; ++level)
    cells_[static_cast<std::size_t>(level)].resize(static_cast<std::size_t>((2 * half_turns_ >> level) + 1));
  const int side = 1 << top_level_;
  Branch root;
  root.level = top_level_;
  for (; root.turn <= 2 * half_turns_; root.turn += 1 << root.turnLevel())
    for (root.dy = 0; root.dy <= 2 * half_cells_; root.dy += side)
      for (root.dx = 0; root.dx <= 2 * half_cells_; root.dx += side) {
        roots_.push_back(root);
        roots_.back().sum = bound(root);
      }
  std::sort(roots_.begin(), roots_.end(), isBetter);
}

/** The points' cells in the middle of the headings from `turn` up, at offset (0, 0). */
const std::vector<Cell>& WindowSearch::cellsAt(int turn_level, int turn) {
  auto& cells = cells_[static_cast<std::size_t>(turn_level)][static_cast<std::size_t>(turn >> turn_level)];
  if (!cells.empty()) return cells;
  const double phi = headingOf(turn + 0.5 * ((1 << turn_level) - 1)), c = std::cos(phi), s = std::sin(phi);
  const double column = map_.column(window_.centre.x) - half_cells_,
               row = map_.row(window_.centre.y) - half_cells_;
  const double scale = 1 / map_.resolution();
  cells.reserve(points_.size());
  for (const auto& p : points_)
    cells.push_back({static_cast<int>(std::floor(column + scale * (c * p.x - s * p.y))),
                     static_cast<int>(std::floor(row + scale * (s * p.x + c * p.y)))});
  return cells;
}

/** Where a branch is looked up. No pose of it scores more: a turn by half of its headings moves no point by
 * more than half its side, so a point stays in a square of twice the side. Exact for leaves. */
WindowSearch::LookUp WindowSearch::lookUpOf(const Branch& branch) {
  const int turn_level = branch.turnLevel(), slack = (1 << turn_level) >> 1;
  return {map_.level(turn_level > 0 ? branch.level + 1 : branch.level), cellsAt(turn_level, branch.turn),
          branch.dx - slack, branch.dy - slack};
}

uint32_t WindowSearch::bound(const Branch& branch) {
  const LookUp at = lookUpOf(branch);
  uint32_t sum = 0;
  for (const Cell& cell : at.cells) sum += at.level.score(cell.column + at.dx, cell.row + at.dy);
  return sum;
}

/** Bounds of a branch and of those half a step of its parent to the right, up, and both; all 0 as soon as it
 * is clear that none reaches `least`. */
std::array<uint32_t, 4> WindowSearch::fourBounds(const Branch& branch, uint32_t least) {
  constexpr std::size_t kTogether = 64;  // whose scores add up to less than 2¹⁶
  constexpr uint32_t kLowBytes = 0x00ff00ff;
  const LookUp at = lookUpOf(branch);
  std::array<uint32_t, 4> sums{};
  for (std::size_t begin = 0; begin < at.cells.size(); begin += kTogether) {
    const std::size_t left = at.cells.size() - begin;
    if (*std::max_element(sums.begin(), sums.end()) + kBestScore * left < least) return {};
    uint32_t lefts = 0, rights = 0;  // two sums in each, the lower cell's in the lower half
    for (std::size_t k = begin; k < begin + std::min(left, kTogether); ++k) {
      const uint32_t scores = at.level.fourScores(at.cells[k].column + at.dx, at.cells[k].row + at.dy);
      lefts += scores & kLowBytes;
      rights += (scores >> 8) & kLowBytes;
    }
    sums[0] += lefts & 0xffff, sums[1] += rights & 0xffff;
    sums[2] += lefts >> 16, sums[3] += rights >> 16;
  }
  return sums;
}

template <class Counts>
Branch WindowSearch::best(uint32_t least, const Counts& counts) {
  Branch best;
  best.level = -1;
  descend(roots_, best, least, counts);
  return best;
}

/** The parts of a branch that may reach `least`, the most promising one first. */
std::vector<Branch> WindowSearch::partsOf(const Branch& branch, uint32_t least) {
  std::vector<Branch> parts;
  const int half = 1 << (branch.level - 1);
  Branch first = branch;
  --first.level;
  for (; first.turn < branch.turn + (1 << branch.turnLevel()); first.turn += 1 << first.turnLevel()) {
    if (!isInside(first)) continue;
    const auto sums = fourBounds(first, least);
    for (int i = 0; i < 4; ++i) {
      Branch part = first;
      part.dx += i % 2 * half;
      part.dy += i / 2 * half;
      part.sum = sums[static_cast<std::size_t>(i)];
      if (isInside(part) && part.sum >= least) parts.push_back(part);
    }
  }
  std::sort(parts.begin(), parts.end(), isBetter);
  return parts;
}

/** Depth first, the most promising branch first; `least` rises with every leaf that is found. */
template <class Counts>
void WindowSearch::descend(const std::vector<Branch>& branches, Branch& best, uint32_t& least,
                           const Counts& counts) {
  for (const Branch& branch : branches) {
    if (branch.sum < least) return;  // and all behind it
    if (branch.level == 0) {
      if (!counts(branch)) continue;
      best = branch;
      least = branch.sum + 1;
      return;
    }
    descend(partsOf(branch, least), best, least, counts);
  }
}

TPose2D WindowSearch::poseOf(const Branch& leaf) const {
  return {window_.centre.x + (leaf.dx - half_cells_) * map_.resolution(),
          window_.centre.y + (leaf.dy - half_cells_) * map_.resolution(),
          mrpt::math::wrapToPi(headingOf(leaf.turn))};
}

}  // namespace

std::optional<WindowMatch> searchWindow(const ScorePyramid& map, const std::vector<TPoint2D>& points,
                                        const PoseWindow& window, double min_score,
                                        const RivalParams& rivals) {
  if (points.empty()) return std::nullopt;
  WindowSearch search(map, points, window);
  const double whole = kBestScore * static_cast<double>(points.size());
  const auto atLeast = [whole](double score) { return static_cast<uint32_t>(std::ceil(whole * score)); };
  const Branch best = search.best(atLeast(min_score), [](const Branch&) { return true; });
  if (best.level < 0) return std::nullopt;

  WindowMatch match{search.poseOf(best), best.sum / whole, 0};
  if (window.half_xy < rivals.distance && window.half_phi < rivals.turn) return match;
  const auto isElsewhere = [&](const Branch& leaf) {
    const TPose2D pose = search.poseOf(leaf);
    return std::hypot(pose.x - match.pose.x, pose.y - match.pose.y) > rivals.distance ||
           std::abs(mrpt::math::wrapToPi(pose.phi - match.pose.phi)) > rivals.turn;
  };
  const Branch rival = search.best(atLeast(rivals.share * match.score), isElsewhere);
  if (rival.level >= 0) match.rival_score = rival.sum / whole;
  return match;
}

}  // namespace submap_slam
