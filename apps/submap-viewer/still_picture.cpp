#include "still_picture.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/viewer/scene_picture.h>

#include <chrono>
#include <thread>

#include "session.h"

namespace submap_slam {

void makePicture(const ViewerOptions& options) {
  Session session(options);
  session.update();
  if (!session.message().empty()) fmt::print(stderr, "submap-viewer: warning: {}\n", session.message());
  if (options.join) {
    session.join(0);
    while (session.joining()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      session.update();
    }
    fmt::print(stderr, "{}\n", session.message());
  }
  if (session.model().moments() == 0) throw InputError("there is nothing to show yet");
  ViewerScene scene;
  scene.update(session.model());
  const double aspect = static_cast<double>(options.width) / options.height;
  writePicture(options.screenshot, *scene.scene(), ViewerScene::viewOfAll(session.model(), aspect),
               options.width, options.height);
}

}  // namespace submap_slam
