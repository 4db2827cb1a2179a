#include "viewer_window.h"

#include <fmt/format.h>
#include <mrpt/gui/CDisplayWindowGUI.h>
#include <mrpt/math/TLine3D.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/viewer/scene_picture.h>
#include <submap_slam/viewer/viewer_scene.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "panels.h"
#include "session.h"

namespace submap_slam {
namespace {

using nanogui::Vector2i;

/** Key codes of GLFW; letters are their capital ASCII codes. */
enum Key : int {
  kEscape = 256,
  kRight = 262,
  kLeft = 263,
  kPageUp = 266,
  kPageDown = 267,
  kHome = 268,
  kEnd = 269,
  kF1 = 290
};

constexpr long kFewScans = 1, kManyScans = 50;

constexpr const char* kHelp[] = {"left, right / page up, page down",
                                 "one scan / 50 scans back and on",
                                 "home, end",
                                 "first and last scan",
                                 "n, b, or a click",
                                 "next and previous submap, or the one there",
                                 "c",
                                 "next loop closure (of the selected submap)",
                                 "x",
                                 "reject that loop closure, or take it back",
                                 "k, d",
                                 "keep the selected submap where it is; drop it from the map",
                                 "o, a",
                                 "hide the selected submap; show all again",
                                 "j, Esc",
                                 "join; stop joining",
                                 "e",
                                 "save the edits",
                                 "g m t f u l r s",
                                 "submaps, map, trajectory, frames, uncertainty, loops, rejected ones, scan",
                                 "v",
                                 "see everything",
                                 "mouse",
                                 "wheel: zoom; right button: move; left button: turn",
                                 "h, F1",
                                 "this help"};

/** The panels are laid out once. */
mrpt::gui::CDisplayWindowGUI_Params windowParameters() {
  mrpt::gui::CDisplayWindowGUI_Params params;
  params.resizable = false;
  return params;
}

class ViewerWindow : public mrpt::gui::CDisplayWindowGUI {
 public:
  ViewerWindow(const ViewerOptions& options, Session& session, const std::string& save_to)
      : CDisplayWindowGUI("submap-viewer", options.width, options.height, windowParameters()),
        session_(session),
        submaps_(*this, session),
        join_(*this, session, save_to),
        timeline_(*this, session) {
    makeHelp();
    performLayout();
    background_scene = scene_.scene();
    camera().setCameraProjective(false);
    addKeyboardCallback([this](int key, int, int action, int) { return action != 0 && onKey(key); });
    addLoopCallback([this] { refresh(); });
    refresh();
    seeAll();
  }

 protected:
  bool mouseButtonEvent(const Vector2i& p, int button, bool down, int modifiers) override;

 private:
  void makeHelp();
  bool onKey(int key);
  bool onModelKey(int key);
  void seeAll();
  void refresh();
  void pick(const Vector2i& p);

  Session& session_;
  ViewerScene scene_;
  SubmapPanel submaps_;
  JoinPanel join_;
  TimelinePanel timeline_;
  nanogui::Window* help_ = nullptr;
  Vector2i pressed_at_{0, 0};
  std::size_t moments_seen_ = 0;
  std::chrono::steady_clock::time_point asked_{};
};

void ViewerWindow::makeHelp() {
  help_ = new nanogui::Window(this, "Keys");
  help_->setLayout(
      new nanogui::GridLayout(nanogui::Orientation::Horizontal, 2, nanogui::Alignment::Minimum, 12, 6));
  for (const char* text : kHelp) help_->add<nanogui::Label>(text)->setFontSize(16);
  help_->setPosition({kListWidth + 20, 60});
  help_->setVisible(false);
}

/** Everything fits into what the panels leave free. */
void ViewerWindow::seeAll() {
  const double free_width = std::max(100, width() - kListWidth - kJoinWidth);
  const double free_height = std::max(100, height() - kTimelineHeight);
  const View view = ViewerScene::viewOfAll(session_.model(), free_width / free_height);
  const double shorter_free = std::min(free_width, free_height), shorter = std::min(width(), height());
  const double pixel_m = view.size / shorter_free;
  camera().setAzimuthDegrees(-90);
  camera().setElevationDegrees(90);
  camera().setZoomDistance(zoomOf(pixel_m * shorter));
  camera().setCameraPointing(static_cast<float>(view.x - pixel_m * (kListWidth - kJoinWidth) / 2),
                             static_cast<float>(view.y - pixel_m * kTimelineHeight / 2), 0);
}

bool ViewerWindow::onModelKey(int key) {
  ViewerModel& model = session_.model();
  for (const LayerKey& layer : layerKeys())
    if (key == layer.key - 'a' + 'A') return model.toggle(layer.layer), true;
  switch (key) {
    case kLeft:
      return model.moveCursor(-kFewScans), true;
    case kRight:
      return model.moveCursor(kFewScans), true;
    case kPageUp:
      return model.moveCursor(-kManyScans), true;
    case kPageDown:
      return model.moveCursor(kManyScans), true;
    case kHome:
      return model.setCursor(0), true;
    case kEnd:
      return model.setCursor(model.moments()), true;
    case 'N':
      return model.selectNext(1), true;
    case 'B':
      return model.selectNext(-1), true;
    case 'C':
      return model.selectNextConstraint(), true;
    case 'X':
      return model.toggleReject(), true;
    case 'K':
      return model.toggleFix(), true;
    case 'D':
      return model.toggleMask(), true;
    case 'O':
      return model.toggleHidden(), true;
    case 'A':
      return model.showAll(), true;
    default:
      return false;
  }
}

bool ViewerWindow::onKey(int key) {
  switch (key) {
    case 'H':
    case kF1:
      return help_->setVisible(!help_->visible()), true;
    case 'V':
      return seeAll(), true;
    case 'J':
      return join_.join(), true;
    case 'E':
      return join_.saveEdits(), true;
    case kEscape:
      return session_.stopJoining(), true;
    default:
      return onModelKey(key);
  }
}

/** A click selects; what moves the mouse turns or moves the view. */
bool ViewerWindow::mouseButtonEvent(const Vector2i& p, int button, bool down, int modifiers) {
  constexpr int kStill_px = 4;
  if (down) pressed_at_ = p;
  const bool in_scene = findWidget(p) == this, still = (p - pressed_at_).cwiseAbs().maxCoeff() < kStill_px;
  if (button == 0 && !down && in_scene && still) pick(p);
  return CDisplayWindowGUI::mouseButtonEvent(p, button, down, modifiers);
}

void ViewerWindow::pick(const Vector2i& p) {
  constexpr double kReach_m = 2;
  mrpt::math::TLine3D ray;
  {
    const std::lock_guard lock(background_scene_mtx);
    background_scene->getViewport()->get3DRayForPixelCoord(p.x(), p.y(), ray);
  }
  if (ray.director.z == 0) return;
  const double t = -ray.pBase.z / ray.director.z;
  session_.model().selectAt(ray.pBase.x + t * ray.director.x, ray.pBase.y + t * ray.director.y, kReach_m);
}

void ViewerWindow::refresh() {
  constexpr auto kInterval = std::chrono::milliseconds(100);
  const auto now = std::chrono::steady_clock::now();
  if (now - asked_ < kInterval) return;
  asked_ = now;
  try {
    session_.update();
    const std::lock_guard lock(background_scene_mtx);
    scene_.update(session_.model());
    clipDepth(*scene_.scene(), camera().getZoomDistance());
  } catch (const std::exception& error) {
    session_.say(error.what());
  }
  if (moments_seen_ == 0 && session_.model().moments() > 0) seeAll();
  moments_seen_ = session_.model().moments();
  submaps_.update();
  join_.update();
  timeline_.update();
}

bool variableSet(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

[[noreturn]] void refuse(const std::string& why) {
  throw OutputError(fmt::format("no display: {}; use --screenshot FILE", why));
}

std::string placeForResults(const ViewerOptions& options) {
  std::filesystem::path source = options.source.empty() ? options.follow : options.source;
  if (!source.has_filename()) source = source.parent_path();
  return source.replace_extension().string() + "-edited";
}

}  // namespace

void showWindow(const ViewerOptions& options) {
  if (!variableSet("DISPLAY") && !variableSet("WAYLAND_DISPLAY"))
    refuse("neither DISPLAY nor WAYLAND_DISPLAY is set");
  Session session(options);
  try {
    nanogui::init();
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  {
    std::unique_ptr<ViewerWindow> window;
    try {
      window = std::make_unique<ViewerWindow>(options, session, placeForResults(options));
    } catch (const std::runtime_error& error) {
      refuse(error.what());
    }
    if (options.join) session.join(0);
    window->drawAll();
    window->setVisible(true);
    constexpr int kIdlePeriod_ms = 25, kRepaintPeriod_ms = 50;
    nanogui::mainloop(kIdlePeriod_ms, kRepaintPeriod_ms);
  }
  nanogui::shutdown();
}

}  // namespace submap_slam
