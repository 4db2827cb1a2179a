#include <submap_slam/viewer/scene_picture.h>

#include <fmt/format.h>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CFBORender.h>
#include <submap_slam/core/errors.h>

namespace submap_slam {
namespace {

mrpt::opengl::CCamera cameraFor(const View& view) {
  mrpt::opengl::CCamera camera;
  camera.setOrthogonal(true);
  camera.setPointingAt(static_cast<float>(view.x), static_cast<float>(view.y), 0);
  camera.setZoomDistance(zoomOf(view.size));
  camera.setAzimuthDegrees(-90);
  camera.setElevationDegrees(90);
  return camera;
}

mrpt::img::CImage render(const mrpt::opengl::COpenGLScene& scene, const View& view, unsigned width,
                         unsigned height) {
  try {
    mrpt::opengl::CFBORender renderer(width, height);
    renderer.setCamera(scene, cameraFor(view));
    clipDepth(scene, zoomOf(view.size));
    mrpt::img::CImage picture;
    renderer.render_RGB(scene, picture);
    return picture;
  } catch (const std::exception& error) {
    const std::string text = error.what();
    throw OutputError("cannot render off-screen: " + text.substr(0, text.find('\n')));
  }
}

}  // namespace

float zoomOf(double shorter_side_m) { return static_cast<float>(2 * shorter_side_m); }

void clipDepth(const mrpt::opengl::COpenGLScene& scene, float zoom) {
  constexpr float kNearest_m = 0.1f, kTurned = 3, kLeast_m = 100;  // a view that is turned is deep
  scene.getViewport()->setViewportClipDistances(kNearest_m, kTurned * zoom + kLeast_m);
}

void writePicture(const std::string& file, const mrpt::opengl::COpenGLScene& scene, const View& view,
                  unsigned width, unsigned height) {
  if (!render(scene, view, width, height).saveToFile(file))
    throw OutputError(fmt::format("{}: cannot be written", file));
}

}  // namespace submap_slam
