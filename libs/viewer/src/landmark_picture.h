#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <submap_slam/core/joined_landmarks.h>

#include <vector>

namespace submap_slam {

/** The features of a submap in its own frame: points with their 3-sigma ellipses, at height z = 0 (m). */
mrpt::opengl::CSetOfObjects::Ptr featurePicture(const LandmarkSubmap& submap, const mrpt::img::TColor& color);

/** The same of joined landmarks, in the map frame. */
mrpt::opengl::CSetOfObjects::Ptr landmarkPicture(const std::vector<JoinedLandmark>& landmarks,
                                                 const mrpt::img::TColor& color);

}  // namespace submap_slam
