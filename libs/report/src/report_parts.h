/** Pieces of JSON that pages are made of. Lengths in m with 4 decimals (0.1 mm), angles in rad with 5. */
#pragma once

#include <mrpt/poses/CPosePDFGaussian.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/packed_evidence.h>
#include <submap_slam/report/map_picture.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace submap_slam {

using Json = nlohmann::ordered_json;

/** Rounded so that numbers take few characters. */
double roundedM(double metres);
double roundedRad(double radians);

inline double degrees(double radians) { return radians * 180 / M_PI; }

/** Standard deviations along the principal axes of a covariance of two coordinates. */
struct SigmaEllipse {
  double major = 0, minor = 0;  ///< m
  double angle = 0;             ///< of the major axis against x (rad)
};
SigmaEllipse sigmaEllipse(double sxx, double sxy, double syy);

/** Members x, y, phi, sigma_major, sigma_minor, sigma_angle and sigma_phi. */
Json frameJson(const mrpt::poses::CPosePDFGaussian& frame);

/** Members sigma_major, sigma_minor and sigma_angle are added. */
void addEllipse(Json& json, const SigmaEllipse& ellipse);

/** Convex hull of the observed cells in another frame: [[x, y], …], counter-clockwise; empty if none is. */
Json outlineJson(const PackedEvidence& evidence, const mrpt::math::TPose2D& T_w_s);

/** Members png (data URI), x_min, x_max, y_min, y_max. */
Json pictureJson(const MapPicture& picture);

/** Of very long logs every n-th pose is enough for a picture. */
constexpr std::size_t kMostPoses = 20000;

/** Longest side of a map picture (px). */
constexpr int kMaxPictureSide = 4096;

}  // namespace submap_slam
