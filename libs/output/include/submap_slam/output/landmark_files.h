/** Files of a map of landmarks. All functions throw OutputError. */
#pragma once

#include <submap_slam/core/joined_landmarks.h>

#include <string>

namespace submap_slam {

/** Writes `id,x,y,sxx,sxy,syy,hits` for each landmark, in the global map frame: position (m), its covariance
 * (m²), observations. Numbers read back to the same bits. */
void writeLandmarks(const std::string& file, const std::vector<JoinedLandmark>& landmarks);

/** Writes `stamp,x,y,phi,sxx,sxy,sxp,syy,syp,spp` for the pose where each submap ends, in the global map
 * frame (s, m, rad), with its covariance; without end stamps positions in the sequence stand for seconds. */
void writeFrames(const std::string& file, const LandmarkSubmaps& submaps, const JoinedLandmarks& joined);

/** Writes `submap,feature,kind,landmark,distance2` for each feature of each submap, see FeatureAssociation;
 * without a landmark near by, distance2 is empty. */
void writeAssociations(const std::string& file, const std::vector<FeatureAssociation>& associations);

/** Writes an mrpt::opengl::COpenGLScene (`.3Dscene`): landmarks and submap frames with 3-sigma ellipses, and
 * the path. */
void writeLandmarkScene(const std::string& file, const JoinedLandmarks& joined, const Trajectory& path);

}  // namespace submap_slam
