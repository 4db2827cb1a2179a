#include <submap_slam/eval/mapping_progress.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/** Wider than the cells of a submap, so that turned ones leave no holes between them. */
constexpr double kSquare_m = 0.2;

/** Where a submap's cells lie in the global map. */
struct PlacedGrid {
  EvidenceSummary grid;
  TPose2D T_w_s;

  /** @param cx, cy cells, halves for centres */
  TPoint2D at(double cx, double cy) const {
    return T_w_s.composePoint({grid.x_min + cx * grid.resolution, grid.y_min + cy * grid.resolution});
  }
};

/** Squares of the global map, each seen or not. */
class SeenArea {
 public:
  explicit SeenArea(const std::vector<PlacedGrid>& submaps) {
    double x_max = std::numeric_limits<double>::lowest(), y_max = x_max;
    for (const auto& submap : submaps)
      for (const int cx : {0, submap.grid.columns})
        for (const int cy : {0, submap.grid.rows}) {
          const TPoint2D corner = submap.at(cx, cy);
          x_min_ = std::min(x_min_, corner.x), y_min_ = std::min(y_min_, corner.y);
          x_max = std::max(x_max, corner.x), y_max = std::max(y_max, corner.y);
        }
    if (submaps.empty()) return;
    columns_ = indexOf(x_max - x_min_) + 1;
    seen_.resize(columns_ * (indexOf(y_max - y_min_) + 1));
  }

  void add(const PackedEvidence& evidence, const PlacedGrid& placed) {
    evidence.forEachObserved([&](int cx, int cy, float, float) { mark(placed.at(cx + 0.5, cy + 0.5)); });
  }

  std::size_t squares() const { return squares_; }

 private:
  static std::size_t indexOf(double offset) { return static_cast<std::size_t>(offset / kSquare_m); }

  void mark(const TPoint2D& point) {
    const std::size_t k = indexOf(point.y - y_min_) * columns_ + indexOf(point.x - x_min_);
    if (seen_[k]) return;
    seen_[k] = true;
    ++squares_;
  }

  double x_min_ = std::numeric_limits<double>::max(), y_min_ = x_min_;  // m
  std::size_t columns_ = 0, squares_ = 0;
  std::vector<bool> seen_;
};

/** Squares seen by each submap and all before it. */
std::vector<std::size_t> squaresSeen(const GridSubmaps& submaps,
                                     const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  std::vector<PlacedGrid> placed;
  for (std::size_t k = 0; k < submaps.size(); ++k)
    placed.push_back({submaps[k]->evidenceSummary(), frames[k].mean.asTPose()});
  SeenArea area(placed);
  std::vector<std::size_t> squares;
  for (std::size_t k = 0; k < submaps.size(); ++k) {  // the evidence of one at a time
    area.add(*submaps[k]->packedEvidence(), placed[k]);
    squares.push_back(area.squares());
  }
  return squares;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::vector<SubmapProgress> mappingProgress(const GridSubmaps& submaps,
                                            const std::vector<mrpt::poses::CPosePDFGaussian>& frames) {
  if (frames.size() != submaps.size()) throw std::invalid_argument("not as many frames as submaps");
  const auto squares = squaresSeen(submaps, frames);
  std::vector<SubmapProgress> progress;
  std::size_t scans = 0, nodes = 0;
  for (const auto& submap : submaps) {
    const SubmapStatistics& s = submap->statistics;
    SubmapProgress p;
    p.id = submap->id;
    p.scans = submap->nodes.size();
    p.nodes = submap->keyNodes();
    p.nodes_sum = nodes += p.nodes;
    p.score = {s.match_score_mean, s.match_score_min, s.match_score_max};
    p.map_share = share(squares[progress.size()], squares.back());
    p.scan_share = static_cast<double>(scans += p.scans);
    progress.push_back(p);
  }
  for (auto& p : progress) p.scan_share = scans == 0 ? 0 : p.scan_share / static_cast<double>(scans);
  return progress;
}

MatchScores overallScores(const std::vector<SubmapProgress>& progress) {
  MatchScores all{0, 1, 0};
  double scans = 0;
  for (const auto& p : progress) {
    if (p.scans == 0) continue;
    const auto count = static_cast<double>(p.scans);
    all.mean += count * p.score.mean;
    scans += count;
    all.min = std::min(all.min, p.score.min);
    all.max = std::max(all.max, p.score.max);
  }
  if (scans == 0) return {};
  all.mean /= scans;
  return all;
}

std::vector<double> stageShares(const std::vector<SubmapProgress>& progress, std::size_t stages) {
  std::vector<double> shares;
  for (std::size_t s = 1; s <= stages && !progress.empty(); ++s)
    shares.push_back(progress[(s * progress.size() + stages - 1) / stages - 1].map_share);
  return shares;
}

std::string progressCsv(const std::vector<SubmapProgress>& progress) {
  std::string text =
      "id,scans,nodes,nodes_sum,score_mean,score_min,score_max,scan_share,map_share,map_share_gain\n";
  double before = 0;
  for (const auto& p : progress) {
    text += fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f}\n", p.id, p.scans, p.nodes,
                        p.nodes_sum, p.score.mean, p.score.min, p.score.max, p.scan_share, p.map_share,
                        p.map_share - before);
    before = p.map_share;
  }
  return text;
}

}  // namespace submap_slam
