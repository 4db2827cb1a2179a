#include <mrpt/core/Clock.h>
#include <submap_slam/output/landmark_files.h>
#include <submap_slam/report/run_report.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "report_parts.h"

namespace submap_slam {
namespace {

using mrpt::poses::CPose2D;
using mrpt::poses::CPosePDFGaussian;

/** Columns of a trajectory: seconds since the first pose, position (m), standard deviation of the position
 * along its worst direction (m), and index of the submap. */
class TrajectoryColumns {
 public:
  void add(mrpt::Clock::time_point stamp, double x, double y, double sigma, std::size_t submap) {
    const double t = mrpt::Clock::toDouble(stamp);
    if (t_.empty()) start_ = t;
    constexpr double kPerSecond = 1e3;
    t_.push_back(std::round((t - start_) * kPerSecond) / kPerSecond);
    x_.push_back(roundedM(x));
    y_.push_back(roundedM(y));
    sigma_.push_back(roundedM(sigma));
    submap_.push_back(submap);
  }

  Json json() const {
    return {{"start", start_}, {"t", t_}, {"x", x_}, {"y", y_}, {"sigma", sigma_}, {"submap", submap_}};
  }

 private:
  double start_ = 0;  // s since 1970
  std::vector<double> t_, x_, y_, sigma_;
  std::vector<std::size_t> submap_;
};

/** Largest standard deviation of the position of a node whose submap's frame is uncertain; the node in its
 * submap counts as exact. First order: d(x, y) = d(x_s, y_s) + dφ_s (−Δy, Δx), Δ the lever arm. */
double nodeSigma(const CPosePDFGaussian& frame, const mrpt::math::TPose2D& T_w_node) {
  const double dx = T_w_node.x - frame.mean.x(), dy = T_w_node.y - frame.mean.y();
  Eigen::Matrix<double, 2, 3> J;
  J << 1, 0, -dy, 0, 1, dx;
  const Eigen::Matrix2d cov = J * frame.cov.asEigen() * J.transpose();
  return sigmaEllipse(cov(0, 0), cov(0, 1), cov(1, 1)).major;
}

Json gridTrajectory(const GridSubmaps& submaps, const JoinedMap& joined) {
  const Trajectory trajectory = trajectoryOf(submaps, joined);
  const std::size_t step = trajectory.size() / kMostPoses + 1;
  TrajectoryColumns columns;
  std::size_t i = 0;
  for (std::size_t k = 0; k < submaps.size(); ++k)
    for (std::size_t n = 0; n < submaps[k]->nodes.size(); ++n, ++i) {
      if (i % step != 0 && i + 1 != trajectory.size()) continue;
      const auto& [stamp, pose] = trajectory[i];
      columns.add(stamp, pose.x, pose.y, nodeSigma(joined.frames[k], pose), k);
    }
  return columns.json();
}

Json submapJson(const GridSubmap& submap, const CPosePDFGaussian& frame, const SubmapProgress& progress) {
  Json json = frameJson(frame);
  json["id"] = submap.id;
  json["scans"] = progress.scans;
  json["nodes"] = progress.nodes;
  json["score"] = {progress.score.mean, progress.score.min, progress.score.max};
  json["map_share"] = progress.map_share;
  json["scan_share"] = progress.scan_share;
  json["rescues"] = submap.statistics.rescues;
  json["particles"] = submap.statistics.max_particles;
  json["closed_because"] = submap.statistics.closed_because;
  json["outline"] = outlineJson(*submap.packedEvidence(), frame.mean.asTPose());
  return json;
}

/** What is left of a constraint after joining: T_a_b⁻¹ (T_w_a⁻¹ T_w_b), as length, angle and in units of its
 * standard deviations √(eᵀ Σ⁻¹ e). */
void addResidual(Json& json, const Constraint& c, const CPosePDFGaussian& a, const CPosePDFGaussian& b) {
  const CPose2D error = (b.mean - a.mean) - c.T_a_b.mean;
  json["left_m"] = roundedM(std::hypot(error.x(), error.y()));
  json["left_deg"] = roundedM(degrees(std::abs(mrpt::math::wrapToPi(error.phi()))));
  // The covariance of T_a_b is in the axes of a, the error in those of b as the constraint has it.
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(c.T_a_b.mean.phi()).toRotationMatrix();
  const Eigen::Vector3d e = R * Eigen::Vector3d(error.x(), error.y(), mrpt::math::wrapToPi(error.phi()));
  const Eigen::LDLT<Eigen::Matrix3d> covariance(c.T_a_b.cov.asEigen());
  const double left2 =
      covariance.isPositive() && covariance.vectorD().minCoeff() > 0 ? e.dot(covariance.solve(e)) : NAN;
  json["left_sigma"] = std::round(std::sqrt(left2) * 100) / 100;
}

Json constraintsJson(const GridSubmaps& submaps, const JoinedMap& joined) {
  std::map<uint32_t, std::size_t> index;
  for (std::size_t k = 0; k < submaps.size(); ++k) index[submaps[k]->id] = k;
  Json constraints = Json::array();
  for (const Constraint& c : joined.constraints) {
    const auto from = index.find(c.from), to = index.find(c.to);
    if (from == index.end() || to == index.end()) continue;  // of a submap that the user masked
    Json json{{"from", from->second},   {"to", to->second},     {"loop", c.inter},
              {"accepted", c.accepted}, {"by_hand", c.by_hand}, {"reason", c.reason}};
    addResidual(json, c, joined.frames[from->second], joined.frames[to->second]);
    constraints.push_back(json);
  }
  return constraints;
}

Json iterationsJson(const std::vector<JoinIteration>& iterations) {
  Json json = Json::array();
  for (const JoinIteration& i : iterations)
    json.push_back(
        {{"level", i.level}, {"cost", i.cost}, {"step_m", i.max_step_m}, {"step_rad", i.max_step_rad}});
  return json;
}

Json landmarkTrajectory(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined) {
  const Trajectory path = trajectoryOf(submaps, joined);
  const bool ends_only = path.size() == submaps.size();
  std::vector<std::size_t> submap_of;  // of each pose
  for (std::size_t k = 0; k < submaps.size(); ++k)
    submap_of.insert(submap_of.end(), ends_only ? 1 : submaps[k]->nodes.size(), k);
  submap_of.resize(path.size(), submaps.size() - 1);
  TrajectoryColumns columns;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto& frame = joined.frames[submap_of[i] + (ends_only ? 1 : 0)];
    columns.add(path[i].stamp, path[i].pose.x, path[i].pose.y, nodeSigma(frame, path[i].pose), submap_of[i]);
  }
  return columns.json();
}

Json landmarksJson(const std::vector<JoinedLandmark>& landmarks) {
  Json json = Json::array();
  for (const JoinedLandmark& l : landmarks) {
    Json landmark{{"id", l.id}, {"x", roundedM(l.x)}, {"y", roundedM(l.y)}, {"hits", l.hits}};
    addEllipse(landmark, sigmaEllipse(l.covariance(0, 0), l.covariance(0, 1), l.covariance(1, 1)));
    json.push_back(landmark);
  }
  return json;
}

/** How many features each kind of association has. */
Json associationCounts(const std::vector<FeatureAssociation>& associations) {
  Json counts = Json::object();
  for (const auto& association : associations) {
    Json& count = counts[toString(association.kind)];
    count = count.is_null() ? 1 : count.get<std::size_t>() + 1;
  }
  return counts;
}

/** What all runs have, at the end of the page's data; metrics, with the times, come last. */
void addRecord(Json& data, const RunRecord& record) {
  data["input"] = record.input;
  data["ini"] = record.ini;
  data["messages"] = record.messages;
  data["metrics"] = record.metrics;
}

}  // namespace

Json runReport(const GridSubmaps& submaps, const JoinedMap& joined,
               const std::vector<SubmapProgress>& progress, const RunRecord& record) {
  if (joined.frames.size() != submaps.size() || progress.size() != submaps.size())
    throw std::invalid_argument("runReport: one frame and one progress for each submap are needed");
  Json data{{"kind", "run"}, {"form", "grid"}};
  data["map"] = pictureJson(mapPicture(joined.map, kMaxPictureSide));
  data["trajectory"] = gridTrajectory(submaps, joined);
  data["submaps"] = Json::array();
  for (std::size_t k = 0; k < submaps.size(); ++k)
    data["submaps"].push_back(submapJson(*submaps[k], joined.frames[k], progress[k]));
  data["constraints"] = constraintsJson(submaps, joined);
  data["iterations"] = iterationsJson(joined.iterations);
  addRecord(data, record);
  return data;
}

Json runReport(const LandmarkSubmaps& submaps, const JoinedLandmarks& joined, const RunRecord& record) {
  if (joined.frames.size() != submaps.size() + 1)
    throw std::invalid_argument("runReport: one frame more than submaps is needed");
  Json data{{"kind", "run"}, {"form", "landmarks"}};
  data["landmarks"] = landmarksJson(joined.landmarks);
  data["trajectory"] = landmarkTrajectory(submaps, joined);
  data["submaps"] = Json::array();
  for (std::size_t k = 0; k < submaps.size(); ++k) {
    Json submap = frameJson(joined.frames[k]);
    submap["id"] = submaps[k]->id;
    submap["features"] = submaps[k]->features.size();
    data["submaps"].push_back(submap);
  }
  data["associations"] = associationCounts(joined.associations);
  data["iterations"] = iterationsJson(joined.iterations);
  addRecord(data, record);
  return data;
}

}  // namespace submap_slam
