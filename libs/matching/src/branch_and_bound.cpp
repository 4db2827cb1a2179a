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

/** Points' cells. What lies before the first one wraps around. */
struct Cells {
  std::vector<uint32_t> columns, rows;
};

/** Sums of the scores of a branch and of those half a step of its parent to the right, up, and both. */
using FourSums = std::array<uint32_t, 4>;

/** Points whose scores add up to less than 2¹⁶. */
constexpr std::size_t kTogether = 64;

/** Adds the scores of points begin … end, no more than kTogether, moved by dx and dy. */
[[gnu::always_inline]] inline void addScores(const ScorePyramid::Level& level, const Cells& cells,
                                             std::size_t begin, std::size_t end, int dx, int dy,
                                             FourSums& sums) {
  constexpr uint32_t kLowBytes = 0x00ff00ff;
  const auto right = static_cast<uint32_t>(dx + level.margin), up = static_cast<uint32_t>(dy + level.margin);
  const uint32_t last_column = level.columns, last_row = level.rows, stride = level.columns + 1;
  const uint32_t *columns = cells.columns.data(), *rows = cells.rows.data(), *fours = level.fours.data();
  uint32_t lefts = 0, rights = 0;  // two sums in each, the lower cell's in the lower half
  for (std::size_t k = begin; k < end; ++k) {
    const uint32_t column = std::min(columns[k] + right, last_column);
    const uint32_t row = std::min(rows[k] + up, last_row);
    const uint32_t scores = fours[row * stride + column];
    lefts += scores & kLowBytes;
    rights += (scores >> 8) & kLowBytes;
  }
  sums[0] += lefts & 0xffff, sums[1] += rights & 0xffff;
  sums[2] += lefts >> 16, sums[3] += rights >> 16;
}

using AddScores = void(const ScorePyramid::Level&, const Cells&, std::size_t, std::size_t, int, int,
                       FourSums&);
void addScoresAnywhere(const ScorePyramid::Level& level, const Cells& cells, std::size_t begin,
                       std::size_t end, int dx, int dy, FourSums& sums) {
  addScores(level, cells, begin, end, dx, dy, sums);
}
#ifdef __x86_64__
[[gnu::target("avx2")]] void addScoresWithAvx2(const ScorePyramid::Level& level, const Cells& cells,
                                               std::size_t begin, std::size_t end, int dx, int dy,
                                               FourSums& sums) {
  addScores(level, cells, begin, end, dx, dy, sums);
}
#endif

AddScores* fastestAddScores() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return addScoresWithAvx2;
#endif
  return addScoresAnywhere;
}

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

int halfCells(double half_xy, double resolution) { return static_cast<int>(std::ceil(half_xy / resolution)); }

/** One search of a window. Offsets and headings run from 0; the window's centre is in their middle. */
class WindowSearch {
 public:
  WindowSearch(const ScorePyramid& map, const std::vector<TPoint2D>& points, const PoseWindow& window);

  /** The best leaf that has at least `least` and is in no branch that `counts` refuses; level < 0: none. */
  template <class Counts>
  Branch best(uint32_t least, const Counts& counts);

  /** What the best leaf has at least: the sum of one at the window's centre. */
  uint32_t sumAtCentre();

  /** Pose at the lowest offset and heading of a branch. */
  TPose2D poseOf(const Branch& branch) const;

  /** Whether no pose of a branch is another place than one in the window. */
  bool isAround(const TPose2D& pose, const Branch& branch, const RivalParams& rivals) const;

 private:
  double headingOf(double turn) const { return window_.centre.phi + (turn - half_turns_) * turn_step_; }
  const Cells& cellsAt(int turn_level, int turn);
  FourSums fourBounds(const Branch& branch, uint32_t least);
  void addFour(Branch first, uint32_t least, std::vector<Branch>& branches);
  std::vector<Branch> roots(uint32_t least);
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
  AddScores* const add_scores_ = fastestAddScores();
  std::vector<std::vector<Cells>> cells_;  ///< by turn level and heading, computed when needed
};

WindowSearch::WindowSearch(const ScorePyramid& map, const std::vector<TPoint2D>& points,
                           const PoseWindow& window)
    : map_(map), points_(points), window_(window) {
  half_cells_ = halfCells(window.half_xy, map.resolution());
  const double step = map.resolution() / std::max(farthest(points), map.resolution());
  half_turns_ = static_cast<int>(std::ceil(window.half_phi / step));
  turn_step_ = half_turns_ > 0 ? window.half_phi / half_turns_ : 0;

  // A branch of one level is bounded by the scores of the next one.
  top_level_ = std::max(0, std::min(map.levels(), usefulLevels(window.half_xy, map.resolution())) - 2);
  cells_.resize(static_cast<std::size_t>(top_level_ + 1));
  for (int level = 0; level <= top_level_; ++level)
    cells_[static_cast<std::size_t>(level)].resize(static_cast<std::size_t>((2 * half_turns_ >> level) + 1));
}

/** The points' cells in the middle of the headings from `turn` up, at offset (0, 0). */
const Cells& WindowSearch::cellsAt(int turn_level, int turn) {
  Cells& cells = cells_[static_cast<std::size_t>(turn_level)][static_cast<std::size_t>(turn >> turn_level)];
  if (!cells.columns.empty()) return cells;
  const double phi = headingOf(turn + 0.5 * ((1 << turn_level) - 1)), c = std::cos(phi), s = std::sin(phi);
  const double column = map_.column(window_.centre.x) - half_cells_,
               row = map_.row(window_.centre.y) - half_cells_;
  const double scale = 1 / map_.resolution();
  const auto cellOf = [](double x) { return static_cast<uint32_t>(static_cast<int>(std::floor(x))); };
  cells.columns.reserve(points_.size());
  cells.rows.reserve(points_.size());
  for (const auto& p : points_) {
    cells.columns.push_back(cellOf(column + scale * (c * p.x - s * p.y)));
    cells.rows.push_back(cellOf(row + scale * (s * p.x + c * p.y)));
  }
  return cells;
}

/** Bounds of a branch and of its neighbours to the right, up, and both; all 0 as soon as it is clear that
 * none reaches `least`. No pose of a branch scores more: a turn by half of its headings moves no point by
 * more than half its side, so a point stays in a square of twice the side. Exact for leaves. */
FourSums WindowSearch::fourBounds(const Branch& branch, uint32_t least) {
  const int turn_level = branch.turnLevel(), slack = (1 << turn_level) >> 1;
  const ScorePyramid::Level& level = map_.level(turn_level > 0 ? branch.level + 1 : branch.level);
  const Cells& cells = cellsAt(turn_level, branch.turn);
  FourSums sums{};
  for (std::size_t begin = 0; begin < points_.size(); begin += kTogether) {
    const std::size_t left = points_.size() - begin;
    if (*std::max_element(sums.begin(), sums.end()) + kBestScore * left < least) return {};
    add_scores_(level, cells, begin, begin + std::min(left, kTogether), branch.dx - slack, branch.dy - slack,
                sums);
  }
  return sums;
}

/** Those of a branch and its neighbours that may reach `least`. */
void WindowSearch::addFour(Branch first, uint32_t least, std::vector<Branch>& branches) {
  if (!isInside(first)) return;
  const FourSums sums = fourBounds(first, least);
  const int side = 1 << first.level;
  for (int i = 0; i < 4; ++i) {
    Branch branch = first;
    branch.dx += i % 2 * side;
    branch.dy += i / 2 * side;
    branch.sum = sums[static_cast<std::size_t>(i)];
    if (isInside(branch) && branch.sum >= least) branches.push_back(branch);
  }
}

uint32_t WindowSearch::sumAtCentre() {
  Branch centre;
  centre.turn = half_turns_;
  centre.dx = centre.dy = half_cells_;
  return fourBounds(centre, 0).front();
}

/** The largest branches, the most promising one first. */
std::vector<Branch> WindowSearch::roots(uint32_t least) {
  std::vector<Branch> roots;
  const int side = 1 << top_level_;
  Branch root;
  root.level = top_level_;
  for (; root.turn <= 2 * half_turns_; root.turn += 1 << root.turnLevel())
    for (root.dy = 0; root.dy <= 2 * half_cells_; root.dy += 2 * side)
      for (root.dx = 0; root.dx <= 2 * half_cells_; root.dx += 2 * side) addFour(root, least, roots);
  std::sort(roots.begin(), roots.end(), isBetter);
  return roots;
}

/** The parts of a branch that may reach `least`, the most promising one first. */
std::vector<Branch> WindowSearch::partsOf(const Branch& branch, uint32_t least) {
  std::vector<Branch> parts;
  Branch first = branch;
  --first.level;
  for (; first.turn < branch.turn + (1 << branch.turnLevel()); first.turn += 1 << first.turnLevel())
    addFour(first, least, parts);
  std::sort(parts.begin(), parts.end(), isBetter);
  return parts;
}

template <class Counts>
Branch WindowSearch::best(uint32_t least, const Counts& counts) {
  Branch best;
  best.level = -1;
  descend(roots(least), best, least, counts);
  return best;
}

/** Depth first, the most promising branch first; `least` rises with every leaf that is found. */
template <class Counts>
void WindowSearch::descend(const std::vector<Branch>& branches, Branch& best, uint32_t& least,
                           const Counts& counts) {
  for (const Branch& branch : branches) {
    if (branch.sum < least) return;  // and all behind it
    if (!counts(branch)) continue;
    if (branch.level == 0) {
      best = branch;
      least = branch.sum + 1;
      return;
    }
    descend(partsOf(branch, least), best, least, counts);
  }
}

TPose2D WindowSearch::poseOf(const Branch& branch) const {
  return {window_.centre.x + (branch.dx - half_cells_) * map_.resolution(),
          window_.centre.y + (branch.dy - half_cells_) * map_.resolution(),
          mrpt::math::wrapToPi(headingOf(branch.turn))};
}

bool WindowSearch::isAround(const TPose2D& pose, const Branch& branch, const RivalParams& rivals) const {
  const int turns = (1 << branch.turnLevel()) - 1, cells = (1 << branch.level) - 1;
  if (turns * turn_step_ > 2 * rivals.turn) return false;
  Branch last = branch;
  last.dx += cells, last.dy += cells, last.turn += turns;
  const TPose2D low = poseOf(branch), high = poseOf(last);
  const auto reach = [](double a, double b) { return std::max(std::abs(a), std::abs(b)); };
  const auto isTurned = [&](const TPose2D& other) {
    return std::abs(mrpt::math::wrapToPi(other.phi - pose.phi)) > rivals.turn;
  };
  return std::hypot(reach(low.x - pose.x, high.x - pose.x), reach(low.y - pose.y, high.y - pose.y)) <=
             rivals.distance &&
         !isTurned(low) && !isTurned(high);
}

/** The least sum of the points' scores with which their mean, in [0, 1], is at least `score`. */
uint32_t leastSum(const std::vector<TPoint2D>& points, double score) {
  return static_cast<uint32_t>(std::ceil(kBestScore * static_cast<double>(points.size()) * score));
}

double meanScore(const std::vector<TPoint2D>& points, uint32_t sum) {
  return sum / (kBestScore * static_cast<double>(points.size()));
}

}  // namespace

int usefulLevels(double half_xy, double resolution) {
  int top_level = 0;
  while ((2 << top_level) <= 2 * halfCells(half_xy, resolution) + 1) ++top_level;
  return top_level + 2;
}

std::optional<WindowMatch> searchWindow(const ScorePyramid& map, const std::vector<TPoint2D>& points,
                                        const PoseWindow& window, double min_score) {
  if (points.empty()) return std::nullopt;
  WindowSearch search(map, points, window);
  const uint32_t least = std::max(leastSum(points, min_score), search.sumAtCentre());
  const Branch best = search.best(least, [](const Branch&) { return true; });
  if (best.level < 0) return std::nullopt;
  return WindowMatch{search.poseOf(best), meanScore(points, best.sum)};
}

double searchRival(const ScorePyramid& map, const std::vector<TPoint2D>& points, const PoseWindow& window,
                   const WindowMatch& found, const RivalParams& rivals) {
  if (points.empty()) return 0;
  WindowSearch search(map, points, window);
  const Branch rival = search.best(leastSum(points, rivals.share * found.score), [&](const Branch& branch) {
    return !search.isAround(found.pose, branch, rivals);
  });
  return rival.level < 0 ? 0 : meanScore(points, rival.sum);
}

}  // namespace submap_slam
