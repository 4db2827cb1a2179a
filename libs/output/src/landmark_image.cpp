#include <submap_slam/output/landmark_image.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "binary_file.h"
#include "drawing.h"

namespace submap_slam {
namespace {

using mrpt::img::CImage;
using mrpt::img::TColor;

/** The part of the plane that is shown. */
class View {
 public:
  void include(double x, double y) {
    x_min_ = std::min(x_min_, x), x_max_ = std::max(x_max_, x);
    y_min_ = std::min(y_min_, y), y_max_ = std::max(y_max_, y);
  }

  /** Chooses the scale once all is included. */
  void fit(int max_side) {
    constexpr double kLeastExtent_m = 1;
    const double extent = std::max({x_max_ - x_min_, y_max_ - y_min_, kLeastExtent_m});
    px_per_m_ = (max_side - 2 * kMargin_px - kFooter_px) / extent;
  }

  double pxPerM() const { return px_per_m_; }
  int width() const {
    return std::max(160, static_cast<int>((x_max_ - x_min_) * px_per_m_) + 2 * kMargin_px);
  }
  int height() const { return static_cast<int>((y_max_ - y_min_) * px_per_m_) + 2 * kMargin_px + kFooter_px; }
  Pixel at(double x, double y) const {
    return {kMargin_px + (x - x_min_) * px_per_m_, kMargin_px + (y_max_ - y) * px_per_m_};
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double x_min_ = kInfinity, x_max_ = -kInfinity, y_min_ = kInfinity, y_max_ = -kInfinity, px_per_m_ = 1;
};

View viewOf(const JoinedLandmarks& joined, const Trajectory& path, int max_side) {
  View view;
  for (const auto& frame : joined.frames) view.include(frame.mean.x(), frame.mean.y());
  for (const auto& landmark : joined.landmarks) view.include(landmark.x, landmark.y);
  for (const auto& [stamp, pose] : path) view.include(pose.x, pose.y);
  view.fit(max_side);
  return view;
}

/** The 3-sigma ellipse as a polygon. */
void drawEllipse(CImage& image, const JoinedLandmark& landmark, const View& view) {
  constexpr int kCorners = 24;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(landmark.covariance.asEigen());
  const Eigen::Matrix2d axes =
      eigen.eigenvectors() * 3 * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  const auto corner = [&](int i) {
    const double angle = 2 * M_PI * i / kCorners;
    const Eigen::Vector2d p = axes * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    return view.at(landmark.x + p.x(), landmark.y + p.y());
  };
  for (int i = 0; i < kCorners; ++i) drawStroke(image, corner(i), corner(i + 1), 0.5, TColor(120, 170, 140));
}

}  // namespace

void writeLandmarkImage(const std::string& file, const JoinedLandmarks& joined, const Trajectory& path,
                        int max_side) {
  constexpr int kMinSide = 200;
  if (max_side < kMinSide)
    throw std::invalid_argument("writeLandmarkImage: max_side must be at least 200 pixels");
  if (joined.frames.empty()) throw std::invalid_argument("writeLandmarkImage: there is nothing to show");
  const View view = viewOf(joined, path, max_side);
  CImage image(static_cast<unsigned>(view.width()), static_cast<unsigned>(view.height()), mrpt::img::CH_RGB);
  image.filledRectangle(0, 0, view.width() - 1, view.height() - 1, TColor(255, 255, 255));
  const auto& start = joined.frames.front().mean;
  std::vector<PathPoint> points{{view.at(start.x(), start.y()), 0}};
  for (const auto& [stamp, pose] : path)
    points.push_back(
        {view.at(pose.x, pose.y), static_cast<double>(points.size()) / static_cast<double>(path.size())});
  for (const auto& landmark : joined.landmarks) drawEllipse(image, landmark, view);
  drawPath(image, points, 1);
  for (const auto& landmark : joined.landmarks) {
    const Pixel p = view.at(landmark.x, landmark.y);
    drawStroke(image, p, p, 2, TColor(20, 130, 70));
  }
  drawScaleBar(image, view.pxPerM());
  writeBytes(file, png(image));
}

}  // namespace submap_slam
