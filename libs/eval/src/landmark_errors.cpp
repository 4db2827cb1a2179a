#include <submap_slam/eval/landmark_errors.h>

#include <fmt/format.h>
#include <mrpt/math/wrap2pi.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/eval/nees.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "table_file.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

uint32_t idOf(const TableRow& row, const std::string& file) {
  const double id = row.values[0];
  if (id < 0 || id != std::floor(id) || id > 4294967295.0)
    throw InputError(fmt::format("{}:{}: the id {} is no whole number, 0 or more", file, row.line, id));
  return static_cast<uint32_t>(id);
}

/** Probability that a χ² variable of n degrees of freedom is below x, by the recurrence from n - 2 to n. */
double chi2Cdf(double x, unsigned n) {
  double p = n % 2 == 0 ? 1 - std::exp(-x / 2) : std::erf(std::sqrt(x / 2));
  for (unsigned k = n % 2 == 0 ? 2 : 1; k < n; k += 2)
    p -= std::exp(k / 2.0 * std::log(x / 2) - x / 2 - std::lgamma(k / 2.0 + 1));
  return p;
}

/** Its inverse in x by bisection. (MRPT's chi2inv is an approximation, 0.9 % too small for n = 2.) */
double chi2Quantile(double probability, unsigned n) {
  double low = 0, high = 10.0 * (n + 2);
  while (high - low > 1e-12 * high)
    (chi2Cdf((low + high) / 2, n) < probability ? low : high) = (low + high) / 2;
  return high;
}

/** Of each landmark of a map the true place in the frame of the map, if there is one. */
using TruePlaces = std::vector<std::optional<TPoint2D>>;

TruePlaces placesById(const std::vector<JoinedLandmark>& landmarks, const LandmarkTruth& truth,
                      const TPose2D& T_truth_map) {
  TruePlaces places(landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    if (const auto known = truth.find(landmarks[i].id); known != truth.end())
      places[i] = T_truth_map.inverseComposePoint(known->second);
  return places;
}

TruePlaces placesByPosition(const std::vector<JoinedLandmark>& landmarks, const LandmarkTruth& truth,
                            const TPose2D& T_truth_map) {
  std::vector<TPoint2D> wanted;
  for (const auto& [id, place] : truth) wanted.push_back(T_truth_map.inverseComposePoint(place));
  std::vector<std::tuple<double, std::size_t, std::size_t>> near;  // distance, landmark, true one
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const double distance = std::hypot(landmarks[i].x - wanted[k].x, landmarks[i].y - wanted[k].y);
      if (distance <= kLandmarkGate_m) near.emplace_back(distance, i, k);
    }
  std::sort(near.begin(), near.end());
  TruePlaces places(landmarks.size());
  std::vector<bool> taken(wanted.size());
  for (const auto& [distance, i, k] : near) {
    if (places[i] || taken[k]) continue;
    places[i] = wanted[k];
    taken[k] = true;
  }
  return places;
}

constexpr const char* kFrameErrorColumns =
    "stamp,error_x,error_y,error_phi,sigma_x,sigma_y,sigma_phi,nees,consistency_index";

}  // namespace

double consistencyIndex(double distance2, unsigned dimension) {
  constexpr double kConfidence = 0.95;
  return distance2 / chi2Quantile(kConfidence, dimension);
}

LandmarkTruth readLandmarkTruth(const std::string& file) {
  LandmarkTruth truth;
  for (const TableRow& row : readTable(file, "id,x,y", true))
    if (!truth.emplace(idOf(row, file), TPoint2D(row.values[1], row.values[2])).second)
      throw InputError(fmt::format("{}:{}: the id {} occurs twice", file, row.line, idOf(row, file)));
  return truth;
}

std::vector<JoinedLandmark> readMappedLandmarks(const std::string& file) {
  std::vector<JoinedLandmark> landmarks;
  for (const TableRow& row : readTable(file, "id,x,y,sxx,sxy,syy,hits", true)) {
    const auto& v = row.values;
    JoinedLandmark landmark;
    landmark.id = idOf(row, file);
    landmark.x = v[1];
    landmark.y = v[2];
    landmark.covariance(0, 0) = v[3];
    landmark.covariance(0, 1) = landmark.covariance(1, 0) = v[4];
    landmark.covariance(1, 1) = v[5];
    landmark.hits = static_cast<uint32_t>(v[6]);
    landmarks.push_back(landmark);
  }
  return landmarks;
}

LandmarkErrors landmarkErrors(const std::vector<JoinedLandmark>& landmarks, const LandmarkTruth& truth,
                              const TPose2D& T_truth_map, LandmarkMatch match) {
  const TruePlaces places = match == LandmarkMatch::kById ? placesById(landmarks, truth, T_truth_map)
                                                          : placesByPosition(landmarks, truth, T_truth_map);
  LandmarkErrors errors;
  double squares = 0, distances2 = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (!places[i]) {
      ++errors.unknown;
      continue;
    }
    const Eigen::Vector2d e(landmarks[i].x - places[i]->x, landmarks[i].y - places[i]->y);
    ++errors.compared;
    squares += e.squaredNorm();
    const Eigen::Matrix2d covariance = landmarks[i].covariance.asEigen();
    distances2 += e.dot(covariance.ldlt().solve(e));
  }
  if (errors.compared == 0) return errors;
  const auto count = static_cast<double>(errors.compared);
  errors.rmse_m = std::sqrt(squares / count);
  errors.mean_nees = distances2 / count;
  errors.mean_index = consistencyIndex(errors.mean_nees, 2);
  return errors;
}

std::vector<TimedFrame> readTimedFrames(const std::string& file) {
  std::vector<TimedFrame> frames;
  for (const TableRow& row : readTable(file, "stamp,x,y,phi,sxx,sxy,sxp,syy,syp,spp", true)) {
    const auto& v = row.values;
    TimedFrame frame;
    frame.t = v[0];
    frame.pose.mean = mrpt::poses::CPose2D(v[1], v[2], v[3]);
    const double upper[3][3] = {{v[4], v[5], v[6]}, {v[5], v[7], v[8]}, {v[6], v[8], v[9]}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) frame.pose.cov(i, j) = upper[i][j];
    frames.push_back(frame);
  }
  return frames;
}

std::vector<FrameError> frameErrors(const std::vector<TimedFrame>& frames, const TimedTrajectory& truth,
                                    const TPose2D& T_truth_map) {
  std::vector<FrameError> errors;
  for (const TimedFrame& frame : frames) {
    const auto T_truth_frame = truth.at(frame.t);
    if (!T_truth_frame) continue;
    const TPose2D wanted = toPose2D(*T_truth_frame) - T_truth_map;
    const auto distance2 = nees(frame.pose, wanted);
    if (!distance2) continue;
    const auto& mean = frame.pose.mean;
    const auto& cov = frame.pose.cov;
    FrameError e;
    e.t = frame.t;
    e.error = {mean.x() - wanted.x, mean.y() - wanted.y, mrpt::math::wrapToPi(mean.phi() - wanted.phi)};
    e.sigma_x = std::sqrt(cov(0, 0));
    e.sigma_y = std::sqrt(cov(1, 1));
    e.sigma_phi = std::sqrt(cov(2, 2));
    e.nees = *distance2;
    e.index = consistencyIndex(*distance2, 3);
    errors.push_back(e);
  }
  return errors;
}

std::string frameErrorsCsv(const std::vector<FrameError>& errors) {
  std::string text = std::string(kFrameErrorColumns) + "\n";
  for (const FrameError& e : errors)
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.8f},{:.6f},{:.6f},{:.8f},{:.6g},{:.6g}\n", e.t, e.error.x,
                        e.error.y, e.error.phi, e.sigma_x, e.sigma_y, e.sigma_phi, e.nees, e.index);
  return text;
}

std::vector<FrameError> readFrameErrors(const std::string& file) {
  std::vector<FrameError> errors;
  for (const TableRow& row : readTable(file, kFrameErrorColumns, true)) {
    const auto& v = row.values;
    errors.push_back({v[0], {v[1], v[2], v[3]}, v[4], v[5], v[6], v[7], v[8]});
  }
  return errors;
}

}  // namespace submap_slam
