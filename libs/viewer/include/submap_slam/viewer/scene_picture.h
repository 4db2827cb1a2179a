#pragma once

#include <submap_slam/viewer/viewer_scene.h>

#include <string>

namespace submap_slam {

/** Renders a scene without any display into a PNG file. Throws OutputError if the file cannot be written or
 * there is nothing to render with.
 * @param width height pixels */
void writePicture(const std::string& file, const mrpt::opengl::COpenGLScene& scene, const View& view,
                  unsigned width, unsigned height);

/** Distance of MRPT's orthogonal camera from which the shorter side of a picture shows that many m. */
float zoomOf(double shorter_side_m);

/** Draws only what is as near to the camera as a scene seen from that distance (m) can be: heights, of which
 * the renderer tells few apart, then count. */
void clipDepth(const mrpt::opengl::COpenGLScene& scene, float zoom);

}  // namespace submap_slam
