#include <submap_slam/viewer/viewer_model.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace submap_slam {

using mrpt::math::TPose2D;

const char* toString(Layer layer) {
  switch (layer) {
    case Layer::kGrids:
      return "submaps";
    case Layer::kMap:
      return "map";
    case Layer::kTrajectory:
      return "trajectory";
    case Layer::kFrames:
      return "frames";
    case Layer::kEllipses:
      return "uncertainty";
    case Layer::kAccepted:
      return "loops";
    case Layer::kRejected:
      return "rejected";
    case Layer::kScan:
      return "scan";
  }
  return "unknown";
}

ViewerModel::ViewerModel()
    : first_moment_{0}, layers_{Layer::kGrids,    Layer::kTrajectory, Layer::kFrames,
                                Layer::kEllipses, Layer::kAccepted,   Layer::kScan} {}

void ViewerModel::setLog(std::vector<Frame> frames) {
  log_ = std::move(frames);
  cursor_ = 0;
}

void ViewerModel::setLandmarks(LandmarkSubmaps submaps) {
  JoinedLandmarks chain;
  chain.frames.emplace_back();
  for (const auto& submap : submaps) {
    const mrpt::math::CMatrixDouble33 covariance(submap->covariance.blockCopy<3, 3>(0, 0));
    const mrpt::poses::CPosePDFGaussian step(mrpt::poses::CPose2D(submap->end_pose), covariance);
    chain.frames.push_back(chain.frames.back() + step);
  }
  landmark_submaps_ = std::move(submaps);
  setJoinedLandmarks(std::move(chain));
  setCursor(moments());
}

void ViewerModel::setJoinedLandmarks(JoinedLandmarks joined) {
  landmark_path_ = trajectoryOf(landmark_submaps_, joined);
  joined_landmarks_ = std::move(joined);
  frames_.clear();
  for (const auto& frame : joined_landmarks_.frames) frames_.push_back(frame.mean.asTPose());
}

void ViewerModel::addSubmaps(const GridSubmaps& more) {
  if (more.empty()) return;
  const bool at_end = cursor_ + 1 >= moments();
  submaps_.insert(submaps_.end(), more.begin(), more.end());
  for (const auto& submap : more) first_moment_.push_back(first_moment_.back() + submap->nodes.size());
  setJoined(std::move(joined_));
  if (at_end) setCursor(moments());
}

void ViewerModel::setJoined(JoinedMap joined) {
  if (joined.frames.size() > submaps_.size())
    throw std::invalid_argument("more frames than there are submaps");
  joined_ = std::move(joined);
  if (joined_.nodes.size() != submaps_.size()) joined_.nodes.clear();
  const JoinedMap chain = chainSubmaps(submaps_);
  while (joined_.frames.size() < submaps_.size()) {
    const std::size_t k = joined_.frames.size();
    joined_.frames.push_back(chain.frames[k]);
    if (k == 0) continue;
    const auto step = chain.frames[k].mean - chain.frames[k - 1].mean;
    joined_.frames[k].mean = joined_.frames[k - 1].mean + step;
  }
  frames_.clear();
  for (const auto& frame : joined_.frames) frames_.push_back(frame.mean.asTPose());
  if (selected_constraint_ && *selected_constraint_ >= joined_.constraints.size())
    selected_constraint_.reset();
}

void ViewerModel::setFrames(const std::vector<TPose2D>& frames) {
  if (frames.size() == submaps_.size()) frames_ = frames;
}

std::size_t ViewerModel::moments() const {
  if (!landmark_submaps_.empty()) return landmark_path_.size();
  return submaps_.empty() ? log_.size() : first_moment_.back();
}

void ViewerModel::setCursor(std::size_t moment) {
  cursor_ = moments() == 0 ? 0 : std::min(moment, moments() - 1);
}

void ViewerModel::moveCursor(long steps) {
  const long target = static_cast<long>(cursor_) + steps;
  setCursor(target < 0 ? 0 : static_cast<std::size_t>(target));
}

Moment ViewerModel::moment(std::size_t position) const {
  if (!landmark_submaps_.empty()) {
    const auto& [stamp, pose] = landmark_path_.at(position);
    return {stamp, pose, std::nullopt, position};
  }
  if (submaps_.empty()) {
    const Frame& frame = log_.at(position);
    return {frame.stamp, frame.odometry.value_or(TPose2D()), std::nullopt, position};
  }
  const auto behind = std::upper_bound(first_moment_.begin(), first_moment_.end(), position);
  const auto k = static_cast<std::size_t>(behind - first_moment_.begin()) - 1;
  const std::size_t n = position - first_moment_[k];
  const SubmapNode& node = submaps_.at(k)->nodes.at(n);
  const TPose2D T_s_node = joined_.nodes.empty() ? node.pose : joined_.nodes[k].at(n);
  return {node.stamp, frames_[k] + T_s_node, k, n};
}

ViewerModel::PlacedScans ViewerModel::scansAtCursor() const {
  if (moments() == 0 || !landmark_submaps_.empty()) return {};
  const Moment here = moment(cursor_);
  if (!here.submap) return {here.pose, log_[here.node].scans};
  const std::vector<SubmapScans> scans = submaps_[*here.submap]->scans();
  for (std::size_t n = here.node + 1; n-- > 0;)
    if (!scans[n].empty()) return {moment(first_moment_[*here.submap] + n).pose, scans[n]};
  return {here.pose, {}};
}

void ViewerModel::select(std::optional<std::size_t> submap) {
  selected_ = submap && *submap < submaps_.size() ? submap : std::nullopt;
  selected_constraint_.reset();
}

void ViewerModel::selectNext(int steps) {
  if (submaps_.empty()) return;
  const auto count = static_cast<long>(submaps_.size());
  const long from = selected_ ? static_cast<long>(*selected_) : steps > 0 ? -1 : 0;
  select(static_cast<std::size_t>(((from + steps) % count + count) % count));
}

void ViewerModel::selectAt(double x, double y, double reach) {
  std::optional<std::size_t> nearest;
  double least = reach;
  for (std::size_t position = 0; !submaps_.empty() && position < moments(); ++position) {
    const Moment there = moment(position);
    const double distance = std::hypot(there.pose.x - x, there.pose.y - y);
    if (hidden(*there.submap) || distance >= least) continue;
    least = distance;
    nearest = there.submap;
  }
  select(nearest);
}

void ViewerModel::selectNextConstraint() {
  const auto& constraints = joined_.constraints;
  const std::size_t start = selected_constraint_ ? *selected_constraint_ + 1 : 0;
  selected_constraint_.reset();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const std::size_t at = (start + i) % constraints.size();
    const Constraint& c = constraints[at];
    const bool of_selected =
        !selected_ || c.from == submaps_[*selected_]->id || c.to == submaps_[*selected_]->id;
    const bool shown = shows(c.accepted ? Layer::kAccepted : Layer::kRejected);
    if (!c.inter || !of_selected || !shown) continue;
    selected_constraint_ = at;
    return;
  }
}

void ViewerModel::toggle(Layer layer) {
  if (layers_.erase(layer) == 0) layers_.insert(layer);
}

void ViewerModel::toggleHidden() {
  if (selected_ && hidden_.erase(*selected_) == 0) hidden_.insert(*selected_);
}

/** Takes the edit back if it is there. */
void ViewerModel::toggleEdit(Edit::Kind kind, uint32_t from, uint32_t to, const std::string& line) {
  const auto isSame = [&](const Edit& e) {
    const bool pair = kind == Edit::Kind::kReject && std::minmax(e.from, e.to) == std::minmax(from, to);
    return e.kind == kind && (pair || (kind != Edit::Kind::kReject && e.to == to));
  };
  const auto removed = std::remove_if(edits_.list.begin(), edits_.list.end(), isSame);
  if (removed != edits_.list.end()) {
    edits_.list.erase(removed, edits_.list.end());
  } else {
    edits_.list.push_back(readEdit(line, "viewer"));
  }
  for (std::size_t i = 0; i < edits_.list.size(); ++i) edits_.list[i].line = i + 1;
}

void ViewerModel::toggleFix() {
  if (!selected_ || *selected_ == 0) return;
  const uint32_t id = submaps_[*selected_]->id;
  const TPose2D T_0_s = frames_[*selected_] - frames_.front();
  toggleEdit(Edit::Kind::kFix, 0, id,
             fmt::format("fix {} {:.4f} {:.4f} {:.5f}", id, T_0_s.x, T_0_s.y, T_0_s.phi));
}

void ViewerModel::toggleMask() {
  if (!selected_) return;
  const uint32_t id = submaps_[*selected_]->id;
  toggleEdit(Edit::Kind::kMask, 0, id, fmt::format("mask {}", id));
}

void ViewerModel::toggleReject() {
  if (!selected_constraint_) return;
  const Constraint& c = joined_.constraints[*selected_constraint_];
  toggleEdit(Edit::Kind::kReject, c.from, c.to, fmt::format("reject {} {}", c.from, c.to));
}

bool ViewerModel::fixed(std::size_t submap) const {
  if (submap >= submaps_.size()) return false;
  const uint32_t id = submaps_[submap]->id;
  return std::any_of(edits_.list.begin(), edits_.list.end(),
                     [id](const Edit& e) { return e.kind == Edit::Kind::kFix && e.to == id; });
}

bool ViewerModel::rejected(const Constraint& constraint) const {
  return std::any_of(edits_.list.begin(), edits_.list.end(), [&constraint](const Edit& e) {
    return e.kind == Edit::Kind::kReject &&
           std::minmax(e.from, e.to) == std::minmax(constraint.from, constraint.to);
  });
}

std::string ViewerModel::editsText() const {
  std::string text;
  for (const Edit& edit : edits_.list) text += edit.text + "\n";
  return text;
}

std::string ViewerModel::status() const {
  if (moments() == 0) return "nothing to show yet";
  const Moment here = moment(cursor_), first = moment(0);
  const double seconds = std::chrono::duration<double>(here.stamp - first.stamp).count();
  std::string text = fmt::format("{} {} of {}, {:.1f} s, x {:.2f} m, y {:.2f} m, {:.1f} deg",
                                 landmark_submaps_.empty() ? "scan" : "pose", cursor_ + 1, moments(), seconds,
                                 here.pose.x, here.pose.y, here.pose.phi * 180 / M_PI);
  if (!landmark_submaps_.empty())
    text += fmt::format(", {} landmark submaps, {} landmarks joined", landmark_submaps_.size(),
                        joined_landmarks_.landmarks.size());
  if (here.submap) text += fmt::format(", submap {}", submaps_[*here.submap]->id);
  if (selected_constraint_) {
    const Constraint& c = joined_.constraints[*selected_constraint_];
    text += fmt::format(" | loop {} - {}: {}{}", c.from, c.to, c.accepted ? "accepted" : "rejected",
                        c.reason.empty() ? "" : ", " + c.reason);
  } else if (selected_) {
    const GridSubmap& s = *submaps_[*selected_];
    text += fmt::format(" | selected: submap {}, {} scans, {:.1f} m, match score {:.2f}", s.id,
                        s.nodes.size(), s.pathLength(), s.statistics.match_score_mean);
  }
  return text;
}

}  // namespace submap_slam
