#include "ekf_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace submap_slam::landmark_mapping {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/** The columns of H that are not zero, as rows of the state: pose and one feature. */
struct Row {
  Predicted predicted;
  Index feature_row = 0;
};

/** P Hᵀ for the two rows of one measurement. */
MatrixXd crossCovariance(const MatrixXd& p, const Row& row) {
  return p.leftCols<3>() * row.predicted.by_pose.transpose() +
         p.middleCols<2>(row.feature_row) * row.predicted.by_feature.transpose();
}

/** H (P Hᵀ), the rows of one measurement. */
MatrixXd throughRow(const Row& row, const MatrixXd& p_ht) {
  return row.predicted.by_pose * p_ht.topRows<3>() +
         row.predicted.by_feature * p_ht.middleRows<2>(row.feature_row);
}

}  // namespace

EkfFilter::EkfFilter(const LandmarkMapperParams& params)
    : params_(params.association), mean_(VectorXd::Zero(3)), covariance_(MatrixXd::Zero(3, 3)) {
  path_.push_back(Pose::Zero());
}

void EkfFilter::predict(const MotionStep& step) {
  const Composition moved = compose(pose(), step.increment);
  mean_.head<3>() = moved.pose;
  const Index rest = mean_.size() - 3;
  const Eigen::Matrix3d p = covariance_.topLeftCorner<3, 3>();
  covariance_.topLeftCorner<3, 3>() =
      moved.by_a * p * moved.by_a.transpose() + moved.by_b * step.covariance * moved.by_b.transpose();
  const MatrixXd cross = moved.by_a * covariance_.topRightCorner(3, rest);
  covariance_.topRightCorner(3, rest) = cross;
  covariance_.bottomLeftCorner(rest, 3) = cross.transpose();
  path_.push_back(pose());
}

std::vector<Pairing> EkfFilter::pairingsOf(std::size_t m, const MeasuredScan& scan,
                                           const Composition& sensor) const {
  const Measurement& measurement = scan.measurements[m];
  std::vector<Pairing> pairings;
  for (std::size_t f = 0; f < tracks_.size(); ++f) {
    if (measurement.known_id) {
      if (tracks_[f].known && tracks_[f].id == *measurement.known_id) return {{m, f, 0}};
      continue;
    }
    const Row rows{predictMeasurement(sensor, feature(f)), row(f)};
    Eigen::Matrix<double, 5, 5> p;  // of the pose and the feature
    p << covariance_.topLeftCorner<3, 3>(), covariance_.block<3, 2>(0, row(f)),
        covariance_.block<2, 3>(row(f), 0), covariance_.block<2, 2>(row(f), row(f));
    Eigen::Matrix<double, 2, 5> h;
    h << rows.predicted.by_pose, rows.predicted.by_feature;
    const Eigen::Matrix2d s = h * p * h.transpose() + measurement.value.noise;
    const double distance2 = squaredDistance(innovationOf(measurement.value.z, rows.predicted.z), s);
    if (distance2 <= params_.new_gate) pairings.push_back({m, f, distance2});
  }
  return pairings;
}

/** Of the measurements that have no feature yet. */
std::vector<Pairing> EkfFilter::pairingsOf(const MeasuredScan& scan,
                                           const std::vector<Origin>& origins) const {
  const Composition sensor = compose(pose(), scan.T_robot_sensor);
  std::vector<Pairing> pairings;
  for (std::size_t m = 0; m < origins.size(); ++m) {
    if (origins[m].kind == Origin::Kind::kFeature) continue;
    const auto own = pairingsOf(m, scan, sensor);
    pairings.insert(pairings.end(), own.begin(), own.end());
  }
  return pairings;
}

void EkfFilter::observe(const MeasuredScan& scan) {
  const std::vector<Origin> none(scan.measurements.size());
  const auto certain = unrivalled(none.size(), pairingsOf(scan, none), params_.match_gate);
  update(scan, newMatches(none, certain));
  const auto origins = assign(certain, pairingsOf(scan, certain), params_.match_gate);
  update(scan, newMatches(certain, origins));
  path_.back() = pose();
  for (std::size_t m = 0; m < origins.size(); ++m)
    if (origins[m].kind == Origin::Kind::kNew) add(scan.T_robot_sensor, scan.measurements[m]);
}

/** All matches at once: K = P Hᵀ S⁻¹, x += K v, P −= K S Kᵀ. */
void EkfFilter::update(const MeasuredScan& scan,
                       const std::vector<std::pair<std::size_t, std::size_t>>& matches) {
  if (matches.empty()) return;
  const auto count = static_cast<Index>(matches.size());
  std::vector<Row> rows;
  VectorXd v(2 * count);
  MatrixXd p_ht(mean_.size(), 2 * count), s(2 * count, 2 * count);
  for (Index i = 0; i < count; ++i) {
    const auto& [m, f] = matches[static_cast<std::size_t>(i)];
    rows.push_back({predictMeasurement(pose(), scan.T_robot_sensor, feature(f)), row(f)});
    v.segment<2>(2 * i) = innovationOf(scan.measurements[m].value.z, rows.back().predicted.z);
    p_ht.middleCols<2>(2 * i) = crossCovariance(covariance_, rows.back());
    ++tracks_[f].hits;
  }
  for (Index i = 0; i < count; ++i) {
    s.middleRows<2>(2 * i) = throughRow(rows[static_cast<std::size_t>(i)], p_ht);
    s.block<2, 2>(2 * i, 2 * i) += scan.measurements[matches[static_cast<std::size_t>(i)].first].value.noise;
  }
  const Eigen::LLT<MatrixXd> llt(s);
  mean_ += p_ht * llt.solve(v);
  // P Hᵀ S⁻¹ H P = Wᵀ W with W = L⁻¹ H P
  MatrixXd w = p_ht.transpose();
  llt.matrixL().solveInPlace(w);
  covariance_.selfadjointView<Eigen::Lower>().rankUpdate(w.transpose(), -1);
  covariance_.triangularView<Eigen::StrictlyUpper>() = covariance_.transpose();
}

void EkfFilter::add(const Pose& T_robot_sensor, const Measurement& measurement) {
  const Located located = locate(pose(), T_robot_sensor, measurement.value.z);
  const Index n = mean_.size();
  const MatrixXd cross = located.by_pose * covariance_.topRows<3>();
  const Eigen::Matrix2d own =
      cross.leftCols<3>() * located.by_pose.transpose() +
      located.by_measurement * measurement.value.noise * located.by_measurement.transpose();
  mean_.conservativeResize(n + 2);
  mean_.tail<2>() = located.feature;
  covariance_.conservativeResize(n + 2, n + 2);
  covariance_.bottomLeftCorner(2, n) = cross;
  covariance_.topRightCorner(n, 2) = cross.transpose();
  covariance_.bottomRightCorner<2, 2>() = own;
  tracks_.push_back({measurement.known_id.value_or(measurement.index), measurement.known_id.has_value(), 1});
}

LandmarkEstimate EkfFilter::estimate() const {
  LandmarkEstimate estimate;
  estimate.pose = pose();
  estimate.path = path_;
  std::vector<Index> rows{0, 1, 2};
  for (std::size_t f = 0; f < tracks_.size(); ++f) {
    const Track& track = tracks_[f];
    if (!track.known && track.hits < static_cast<uint32_t>(params_.min_hits)) continue;
    estimate.features.push_back({track.id, feature(f).x(), feature(f).y(), track.hits});
    rows.push_back(row(f)), rows.push_back(row(f) + 1);
  }
  estimate.covariance = covariance_(rows, rows);
  return estimate;
}

}  // namespace submap_slam::landmark_mapping
