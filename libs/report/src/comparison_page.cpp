#include <submap_slam/report/comparison.h>

#include <cmath>

#include "report_parts.h"

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

double toMilliseconds(double seconds) { return std::round(seconds * 1e3) / 1e3; }

/** The path in the frame of the reference. */
Json pathJson(const TimedTrajectory& trajectory, const TPose2D& T_ref_w) {
  std::vector<double> x, y;
  const std::size_t step = trajectory.poses().size() / kMostPoses + 1;
  for (std::size_t i = 0; i < trajectory.poses().size(); i += step) {
    const TPose2D pose = T_ref_w + toPose2D(trajectory.poses()[i].pose);
    x.push_back(roundedM(pose.x)), y.push_back(roundedM(pose.y));
  }
  return {{"x", x}, {"y", y}};
}

Json differencesJson(const std::vector<PosePair>& pairs, double start) {
  std::vector<double> t, apart_m, turned_deg;
  const std::size_t step = pairs.size() / kMostPoses + 1;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    const auto& [time, reference, estimate] = pairs[i];
    t.push_back(toMilliseconds(time - start));
    apart_m.push_back(roundedM(std::hypot(estimate.x - reference.x, estimate.y - reference.y)));
    turned_deg.push_back(roundedM(mrpt::math::wrapToPi(estimate.phi - reference.phi) * 180 / M_PI));
  }
  return {{"t", t}, {"apart_m", apart_m}, {"turned_deg", turned_deg}};
}

Json runJson(const RunFolder& run, const std::string& name, const SeenFromReference& seen, double start) {
  Json json{{"name", name}, {"path", pathJson(run.trajectory, seen.T_ref_w)}};
  if (run.map) json["map"] = pictureJson(mapPicture(*run.map, seen.T_ref_w, kMaxPictureSide));
  json["landmarks"] = Json::array();
  for (const TPoint2D& landmark : run.landmarks) {
    const TPoint2D p = seen.T_ref_w.composePoint(landmark);
    json["landmarks"].push_back({{"x", roundedM(p.x)}, {"y", roundedM(p.y)}});
  }
  json["differences"] = differencesJson(seen.pairs, start);
  return json;
}

}  // namespace

Json comparisonPage(const std::vector<RunFolder>& runs, const Comparison& comparison) {
  Json data{{"kind", "comparison"}, {"runs", Json::array()}, {"tables", Json::array()}};
  const double start = runs.front().trajectory.poses().front().t;
  for (std::size_t k = 0; k < runs.size(); ++k)
    data["runs"].push_back(runJson(runs[k], comparison.names[k], comparison.seen[k], start));
  for (const ComparisonTable& table : comparison.tables) {
    Json rows = Json::array();
    for (const ComparisonRow& row : table.rows) rows.push_back({{"name", row.name}, {"values", row.values}});
    data["tables"].push_back({{"title", table.title}, {"rows", rows}});
  }
  return data;
}

}  // namespace submap_slam
