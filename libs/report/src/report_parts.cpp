#include "report_parts.h"

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

using mrpt::math::TPoint2D;

/** z component of (a − o) × (b − o). */
double cross(const TPoint2D& o, const TPoint2D& a, const TPoint2D& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/** Adds one half of the hull of points in the order of their x (Andrew's monotone chain). */
template <class Iterator>
void addHalfHull(Iterator begin, Iterator end, std::vector<TPoint2D>& hull) {
  const std::size_t start = hull.size();
  for (auto p = begin; p != end; ++p) {
    while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), *p) <= 0) hull.pop_back();
    hull.push_back(*p);
  }
  if (!hull.empty()) hull.pop_back();  // the other half begins with it
}

std::vector<TPoint2D> convexHull(std::vector<TPoint2D> points) {
  std::sort(points.begin(), points.end(),
            [](const TPoint2D& a, const TPoint2D& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<TPoint2D> hull;
  addHalfHull(points.begin(), points.end(), hull);
  addHalfHull(points.rbegin(), points.rend(), hull);
  return hull;
}

/** First and last observed cell of each row that has one, by their outer corners in the local map frame. */
std::vector<TPoint2D> rowEnds(const PackedEvidence& evidence) {
  struct Row {
    int first = 0, last = -1;
  };
  std::vector<Row> rows(static_cast<std::size_t>(evidence.sizeY()));
  evidence.forEachObserved([&](int cx, int cy, float, float) {
    Row& row = rows[static_cast<std::size_t>(cy)];
    row = row.last < row.first ? Row{cx, cx} : Row{std::min(row.first, cx), std::max(row.last, cx)};
  });
  std::vector<TPoint2D> ends;
  const double r = evidence.resolution();
  for (std::size_t cy = 0; cy < rows.size(); ++cy) {
    if (rows[cy].last < rows[cy].first) continue;
    for (const int edge : {0, 1})
      for (const int cx : {rows[cy].first, rows[cy].last + 1})
        ends.emplace_back(evidence.xMin() + cx * r, evidence.yMin() + (static_cast<double>(cy) + edge) * r);
  }
  return ends;
}

}  // namespace

double roundedM(double metres) { return std::round(metres * 1e4) / 1e4; }
double roundedRad(double radians) { return std::round(radians * 1e5) / 1e5; }

SigmaEllipse sigmaEllipse(double sxx, double sxy, double syy) {
  // Eigenvalues of a symmetric 2 × 2 matrix: centre ± radius.
  const double centre = (sxx + syy) / 2, radius = std::hypot((sxx - syy) / 2, sxy);
  return {std::sqrt(std::max(0.0, centre + radius)), std::sqrt(std::max(0.0, centre - radius)),
          std::atan2(2 * sxy, sxx - syy) / 2};
}

void addEllipse(Json& json, const SigmaEllipse& ellipse) {
  json["sigma_major"] = roundedM(ellipse.major);
  json["sigma_minor"] = roundedM(ellipse.minor);
  json["sigma_angle"] = roundedRad(ellipse.angle);
}

Json frameJson(const mrpt::poses::CPosePDFGaussian& frame) {
  Json json{{"x", roundedM(frame.mean.x())},
            {"y", roundedM(frame.mean.y())},
            {"phi", roundedRad(frame.mean.phi())}};
  addEllipse(json, sigmaEllipse(frame.cov(0, 0), frame.cov(0, 1), frame.cov(1, 1)));
  json["sigma_phi"] = roundedRad(std::sqrt(frame.cov(2, 2)));
  return json;
}

Json outlineJson(const PackedEvidence& evidence, const mrpt::math::TPose2D& T_w_s) {
  Json outline = Json::array();
  for (const TPoint2D& corner : convexHull(rowEnds(evidence))) {
    const TPoint2D p = T_w_s.composePoint(corner);
    outline.push_back({roundedM(p.x), roundedM(p.y)});
  }
  return outline;
}

Json pictureJson(const MapPicture& picture) {
  return {{"png", pngDataUri(picture)},
          {"x_min", picture.x_min},
          {"x_max", picture.xMax()},
          {"y_min", picture.y_min},
          {"y_max", picture.yMax()}};
}

}  // namespace submap_slam
