#include <submap_slam/landmarks/pole_detector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;

constexpr double kPi = 3.141592653589793;

struct Beam {
  double range;  ///< m
  double angle;  ///< rad, from the first beam in the direction of the others
};

/** Beams next to each other on one surface: positions of the first and the last one. */
struct Cluster {
  std::size_t first, last;
  bool dropped = false;
};

/** Logs hold apertures as float; what was meant is taken to be a multiple of 0.001°. */
double apertureOf(const CObservation2DRangeScan& scan) {
  const double degrees = static_cast<double>(scan.aperture) * 180 / kPi;
  return std::round(degrees * 1000) / 1000 * kPi / 180;
}

std::vector<Beam> validBeams(const CObservation2DRangeScan& scan, double max_range) {
  std::vector<Beam> beams;
  const std::size_t count = scan.getScanSize();
  const double aperture = apertureOf(scan);
  for (std::size_t i = 0; i < count; ++i) {
    const auto range = static_cast<double>(scan.getScanRange(i));
    if (!scan.getScanRangeValidity(i) || !(range < max_range)) continue;
    beams.push_back({range, static_cast<double>(i) * aperture / static_cast<double>(count - 1)});
  }
  return beams;
}

double distance(const Beam& a, const Beam& b) {
  return std::hypot(a.range * std::cos(a.angle) - b.range * std::cos(b.angle),
                    a.range * std::sin(a.angle) - b.range * std::sin(b.angle));
}

std::vector<Cluster> split(const std::vector<Beam>& beams, const PoleDetectorParams& params) {
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const bool apart = i == 0 || std::abs(beams[i].range - beams[i - 1].range) > params.split_distance ||
                       beams[i].angle - beams[i - 1].angle > params.split_angle;
    if (apart) clusters.push_back({i, i});
    clusters.back().last = i;
  }
  return clusters;
}

/** Drops what is part of something larger: poles stand alone. */
void dropCrowded(std::vector<Cluster>& clusters, const std::vector<Beam>& beams, double clearance) {
  constexpr std::size_t kNext = 3;
  for (std::size_t k = 0; k < clusters.size(); ++k)
    for (std::size_t n = k + 1; n < std::min(k + 1 + kNext, clusters.size()); ++n)
      if (distance(beams[clusters[k].last], beams[clusters[n].first]) < clearance)
        clusters[k].dropped = clusters[n].dropped = true;
}

/** Drops what may be partly hidden. */
void dropHidden(std::vector<Cluster>& clusters, const std::vector<Beam>& beams, double min_gap) {
  for (std::size_t k = 0; k + 1 < clusters.size(); ++k) {
    const Beam &end = beams[clusters[k].last], &begin = beams[clusters[k + 1].first];
    if (begin.angle - end.angle >= min_gap) continue;
    clusters[begin.range > end.range ? k + 1 : k].dropped = true;
  }
}

}  // namespace

void describe(ParameterTable& table, PoleDetectorParams& params) {
  table.section("detector", "Poles and tree trunks in laser scans, as landmarks (Guivant 1999)");
  table.add("enabled", params.enabled, "Whether poles that are detected in scans are landmarks");
  table.add("min_range", params.min_range, "m", {0, 1000}, "Nearer ones are none");
  table.add("max_range", params.max_range, "m", {0.1, 1000}, "Beams with this range or more count as empty");
  table.add("split_distance", params.split_distance, "m", {0, 1000},
            "Two beams whose ranges differ by more hit different things");
  table.add("split_angle", params.split_angle, "rad", {0, 6.3},
            "Two beams with a wider gap between them hit different things");
  table.add("clearance", params.clearance, "m", {0, 1000},
            "What is closer than this to one of the next three things is no pole");
  table.add("min_gap", params.min_gap, "rad", {0, 6.3},
            "Of two things with a smaller gap between them the farther one is left out");
  table.add("max_width", params.max_width, "m", {0, 100}, "What is wider is no pole");
  table.add("edge", params.edge, "rad", {0, 3.1},
            "What reaches so far towards the first or the last beam is left out");
  table.add("max_slant", params.max_slant, "", {0, 100},
            "The outer two ranges of a pole differ by less than this times its diameter");
}

std::vector<Pole> detectPoles(const CObservation2DRangeScan& scan, const PoleDetectorParams& params) {
  std::vector<Pole> poles;
  if (scan.getScanSize() < 2) return poles;
  const std::vector<Beam> beams = validBeams(scan, params.max_range);
  std::vector<Cluster> clusters = split(beams, params);
  dropCrowded(clusters, beams, params.clearance);
  dropHidden(clusters, beams, params.min_gap);
  const double aperture = apertureOf(scan);
  const double step = aperture / static_cast<double>(scan.getScanSize() - 1);
  for (const Cluster& cluster : clusters) {
    const Beam &first = beams[cluster.first], &last = beams[cluster.last];
    if (cluster.dropped || distance(first, last) >= params.max_width) continue;
    if (first.range <= params.min_range || first.angle <= params.edge || last.angle >= aperture - params.edge)
      continue;
    const double diameter = (last.angle - first.angle + step) * (first.range + last.range) / 2;
    if (std::abs(first.range - last.range) >= diameter * params.max_slant) continue;
    const std::size_t sum = cluster.first + cluster.last;
    const double middle = (beams[sum / 2].range + beams[(sum + 1) / 2].range) / 2;
    const double along = (first.angle + last.angle - aperture) / 2;
    poles.push_back({middle + diameter / 2, scan.rightToLeft ? along : -along, diameter});
  }
  return poles;
}

LandmarkScan poleLandmarks(const CObservation2DRangeScan& scan, const PoleDetectorParams& params) {
  const auto& pose = scan.sensorPose;
  const double mirror = std::cos(pose.roll()) < 0 ? -1.0 : 1.0;  // mounted upside down
  LandmarkScan landmarks;
  landmarks.sensor_label = scan.sensorLabel;
  landmarks.T_robot_sensor = {pose.x(), pose.y(), pose.yaw()};
  landmarks.max_range = params.max_range;
  landmarks.field_of_view = apertureOf(scan);
  for (const Pole& pole : detectPoles(scan, params))
    landmarks.measurements.push_back({pole.range, mirror * pole.bearing, std::nullopt});
  return landmarks;
}

}  // namespace submap_slam
