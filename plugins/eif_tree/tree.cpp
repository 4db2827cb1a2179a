#include "tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "information_form.h"

namespace submap_slam::landmark_joining {

/** One call of JoiningTree::join. */
class JoiningTree::Work {
 public:
  Work(const TreeOptions& options, const JointProblem& whole, const std::vector<uint32_t>& ids,
       const std::function<bool(double)>& progress, std::size_t joined_before)
      : options_(options), whole_(whole), ids_(ids), progress_(progress), local_(whole.landmark_count) {
    const auto added = static_cast<double>(whole.submaps() - joined_before);
    // Each of about log₂ K levels counts alike, and the last joins as one more.
    expected_ =
        added * std::log2(static_cast<double>(whole.submaps()) + 1) + static_cast<double>(whole.submaps());
  }

  Part leaf(std::size_t k) const;

  Part join(const Part& left, const Part& right, bool refined) {
    Part both = merge(left, right);
    if (refined) {
      stopped_ = stopped_ || !going_on_;
      if (going_on_ && !failed_) refine(both);
    }
    joined_ += static_cast<double>(both.size());
    going_on_ = going_on_ && (!progress_ || progress_(std::min(1.0, joined_ / expected_)));
    return both;
  }

  bool failed() const { return failed_; }
  bool stopped() const { return stopped_; }

 private:
  static Part merge(const Part& left, const Part& right);
  void refine(Part& part);
  JointProblem problemOf(const Part& part);

  const TreeOptions& options_;
  const JointProblem& whole_;
  const std::vector<uint32_t>& ids_;
  const std::function<bool(double)>& progress_;
  std::vector<int> local_;  // index of each landmark in the part at work
  double joined_ = 0, expected_ = 1;
  bool going_on_ = true, failed_ = false, stopped_ = false;
};

JoiningTree::Part JoiningTree::Work::leaf(std::size_t k) const {
  const Eigen::VectorXd& z = whole_.observations[k]->z;
  std::vector<std::pair<int, int>> order;  // landmark, row
  for (std::size_t i = 0; i < whole_.landmarks[k].size(); ++i)
    order.emplace_back(whole_.landmarks[k][i], 3 + 2 * static_cast<int>(i));
  std::sort(order.begin(), order.end());
  Part part;
  part.first = k, part.last = k + 1;
  part.state.ends.push_back(z.head<3>());
  for (const auto& [landmark, row] : order) {
    part.landmarks.push_back(ids_[static_cast<std::size_t>(landmark)]);
    part.state.landmarks.emplace_back(z.segment<2>(row));
  }
  return part;
}

JoiningTree::Part JoiningTree::Work::merge(const Part& left, const Part& right) {
  const Pose frame = left.state.ends.back();
  Part both;
  both.first = left.first, both.last = right.last;
  both.state.ends = left.state.ends;
  for (const Pose& end : right.state.ends) both.state.ends.push_back(compose(frame, end));
  std::size_t a = 0, b = 0;
  while (a < left.landmarks.size() || b < right.landmarks.size()) {
    const bool from_left =
        b == right.landmarks.size() || (a < left.landmarks.size() && left.landmarks[a] <= right.landmarks[b]);
    if (from_left) {
      if (b < right.landmarks.size() && left.landmarks[a] == right.landmarks[b]) ++b;
      both.landmarks.push_back(left.landmarks[a]);
      both.state.landmarks.push_back(left.state.landmarks[a++]);
    } else {
      both.landmarks.push_back(right.landmarks[b]);
      both.state.landmarks.push_back(compose(frame, right.state.landmarks[b++]));
    }
  }
  return both;
}

JointProblem JoiningTree::Work::problemOf(const Part& part) {
  auto at = ids_.begin();
  for (std::size_t i = 0; i < part.landmarks.size(); ++i) {
    at = std::lower_bound(at, ids_.end(), part.landmarks[i]);
    local_[static_cast<std::size_t>(at - ids_.begin())] = static_cast<int>(i);
  }
  JointProblem problem;
  problem.landmark_count = part.landmarks.size();
  for (std::size_t k = part.first; k < part.last; ++k) {
    problem.observations.push_back(whole_.observations[k]);
    std::vector<int> landmarks;
    landmarks.reserve(whole_.landmarks[k].size());
    for (const int landmark : whole_.landmarks[k])
      landmarks.push_back(local_[static_cast<std::size_t>(landmark)]);
    problem.landmarks.push_back(std::move(landmarks));
  }
  return problem;
}

void JoiningTree::Work::refine(Part& part) {
  const JointProblem problem = problemOf(part);
  InformationForm form(problem);
  for (int step = 0; step < options_.steps_per_join; ++step) {
    form.lineariseAll(part.state);
    failed_ = failed_ || !form.factorize();
    if (failed_) return;
    part.state = form.moved(part.state, form.step());
  }
}

std::optional<TreeResult> JoiningTree::join(const JointProblem& problem, const std::vector<uint32_t>& ids,
                                            const std::function<bool(double)>& progress) {
  const std::size_t before = parts_.empty() ? 0 : parts_.back().last;
  Work work(options_, problem, ids, progress, before);
  for (std::size_t k = before; k < problem.submaps(); ++k) {
    parts_.push_back(work.leaf(k));
    while (parts_.size() > 1 && parts_[parts_.size() - 2].size() == parts_.back().size()) {
      const Part right = std::move(parts_.back());
      parts_.pop_back();
      parts_.back() = work.join(parts_.back(), right, true);
    }
  }
  Part whole = parts_.back();
  for (std::size_t i = parts_.size() - 1; i-- > 0;)
    whole = work.join(parts_[i], whole, options_.refine_root || i > 0);
  if (work.failed() || work.stopped()) parts_.clear();
  if (work.failed()) return std::nullopt;
  return TreeResult{std::move(whole.state), work.stopped()};
}

}  // namespace submap_slam::landmark_joining
