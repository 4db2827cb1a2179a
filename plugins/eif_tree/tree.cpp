#include "tree.h"

#include <algorithm>

#include "information_form.h"

namespace submap_slam::landmark_joining {
namespace {

/** Estimate of the submaps [first, last) in the frame of the first one's start. */
struct Part {
  std::size_t first = 0, last = 0;
  JointState state;
  std::vector<int> landmarks;  ///< which landmarks of the whole problem the state's are, ascending
};

class TreeJoin {
 public:
  TreeJoin(const JointProblem& whole, const TreeOptions& options, const std::function<bool(double)>& progress)
      : whole_(whole), options_(options), progress_(progress), local_(whole.landmark_count) {}

  Part join(std::size_t first, std::size_t last) {
    if (last - first == 1) return leaf(first);
    const std::size_t middle = first + (last - first) / 2;
    const Part left = join(first, middle), right = join(middle, last);
    Part both = merge(left, right);
    const bool is_root = last - first == whole_.submaps();
    if (options_.refine_root || !is_root) {
      stopped_ = stopped_ || !going_on_;
      if (going_on_ && !failed_) refine(both);
    }
    joined_ += last - first;
    going_on_ = going_on_ && (!progress_ || progress_(shareDone()));
    return both;
  }

  bool failed() const { return failed_; }
  bool stopped() const { return stopped_; }

 private:
  Part leaf(std::size_t k) const;
  Part merge(const Part& left, const Part& right) const;
  void refine(Part& part);
  JointProblem problemOf(const Part& part);

  /** Each of about log₂ K levels counts alike. */
  double shareDone() const {
    double levels = 0;
    for (std::size_t n = 1; n < whole_.submaps(); n *= 2) ++levels;
    return std::min(1.0, static_cast<double>(joined_) / (levels * static_cast<double>(whole_.submaps())));
  }

  const JointProblem& whole_;
  const TreeOptions& options_;
  const std::function<bool(double)>& progress_;
  std::vector<int> local_;  // index of each landmark in the part at work
  std::size_t joined_ = 0;
  bool going_on_ = true, failed_ = false, stopped_ = false;
};

Part TreeJoin::leaf(std::size_t k) const {
  const Eigen::VectorXd& z = whole_.observations[k]->z;
  std::vector<std::pair<int, int>> order;  // landmark, row
  for (std::size_t i = 0; i < whole_.landmarks[k].size(); ++i)
    order.emplace_back(whole_.landmarks[k][i], 3 + 2 * static_cast<int>(i));
  std::sort(order.begin(), order.end());
  Part part;
  part.first = k, part.last = k + 1;
  part.state.ends.push_back(z.head<3>());
  for (const auto& [landmark, row] : order) {
    part.landmarks.push_back(landmark);
    part.state.landmarks.emplace_back(z.segment<2>(row));
  }
  return part;
}

Part TreeJoin::merge(const Part& left, const Part& right) const {
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

JointProblem TreeJoin::problemOf(const Part& part) {
  for (std::size_t i = 0; i < part.landmarks.size(); ++i)
    local_[static_cast<std::size_t>(part.landmarks[i])] = static_cast<int>(i);
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

void TreeJoin::refine(Part& part) {
  const JointProblem problem = problemOf(part);
  InformationForm form(problem);
  for (int step = 0; step < options_.steps_per_join; ++step) {
    form.lineariseAll(part.state);
    failed_ = failed_ || !form.factorize();
    if (failed_) return;
    part.state = form.moved(part.state, form.step());
  }
}

}  // namespace

std::optional<TreeResult> joinTree(const JointProblem& problem, const TreeOptions& options,
                                   const std::function<bool(double)>& progress) {
  TreeJoin tree(problem, options, progress);
  Part whole = tree.join(0, problem.submaps());
  if (tree.failed()) return std::nullopt;
  return TreeResult{std::move(whole.state), tree.stopped()};
}

}  // namespace submap_slam::landmark_joining
