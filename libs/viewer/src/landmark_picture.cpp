#include "landmark_picture.h"

#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>

#include <algorithm>
#include <cmath>

namespace submap_slam {
namespace {

/** Points with ellipses around them. */
class EllipsePicture {
 public:
  explicit EllipsePicture(const mrpt::img::TColor& color) {
    lines_->setColor_u8(color);
    lines_->setLineWidth(1);
    lines_->setName("ellipses");
    points_->setColor_u8(color);
    points_->setPointSize(4);
    points_->setName("landmarks");
  }

  /** @param sxx sxy syy covariance (m²) of the point, which must not be indefinite */
  void add(double x, double y, double sxx, double sxy, double syy) {
    points_->insertPoint(static_cast<float>(x), static_cast<float>(y), 0);
    if (!(sxx > 0)) return;
    constexpr int kCorners = 24;
    constexpr double kSigmas = 3;
    // The Cholesky factor takes the unit circle to the ellipse of one sigma.
    const double l11 = std::sqrt(sxx), l21 = sxy / l11, l22 = std::sqrt(std::max(0.0, syy - l21 * l21));
    double x0 = x + kSigmas * l11, y0 = y + kSigmas * l21;
    for (int i = 1; i <= kCorners; ++i) {
      const double angle = 2 * M_PI * i / kCorners, c = std::cos(angle), s = std::sin(angle);
      const double x1 = x + kSigmas * l11 * c, y1 = y + kSigmas * (l21 * c + l22 * s);
      lines_->appendLine(x0, y0, 0, x1, y1, 0);
      x0 = x1, y0 = y1;
    }
  }

  mrpt::opengl::CSetOfObjects::Ptr objects() const {
    auto both = mrpt::opengl::CSetOfObjects::Create();
    both->insert(lines_);
    both->insert(points_);
    return both;
  }

 private:
  mrpt::opengl::CSetOfLines::Ptr lines_ = mrpt::opengl::CSetOfLines::Create();
  mrpt::opengl::CPointCloud::Ptr points_ = mrpt::opengl::CPointCloud::Create();
};

}  // namespace

mrpt::opengl::CSetOfObjects::Ptr featurePicture(const LandmarkSubmap& submap,
                                                const mrpt::img::TColor& color) {
  EllipsePicture picture(color);
  for (std::size_t i = 0; i < submap.features.size(); ++i) {
    const std::size_t k = 3 + 2 * i;
    const auto& Q = submap.covariance;
    picture.add(submap.features[i].x, submap.features[i].y, Q(k, k), Q(k, k + 1), Q(k + 1, k + 1));
  }
  return picture.objects();
}

mrpt::opengl::CSetOfObjects::Ptr landmarkPicture(const std::vector<JoinedLandmark>& landmarks,
                                                 const mrpt::img::TColor& color) {
  EllipsePicture picture(color);
  for (const JoinedLandmark& l : landmarks)
    picture.add(l.x, l.y, l.covariance(0, 0), l.covariance(0, 1), l.covariance(1, 1));
  return picture.objects();
}

}  // namespace submap_slam
