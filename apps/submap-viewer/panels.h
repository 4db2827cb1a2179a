/** The parts of the window that hold buttons. Each shows the session and changes it. */
#pragma once

#include <mrpt/gui/CDisplayWindowGUI.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session.h"

namespace submap_slam {

constexpr int kListWidth = 250, kJoinWidth = 330, kTimelineHeight = 120;  ///< pixels

/** List of the submaps at the left. */
class SubmapPanel {
 public:
  SubmapPanel(nanogui::Screen& screen, Session& session);
  void update();

 private:
  nanogui::Screen& screen_;
  Session& session_;
  nanogui::Window* window_;
  nanogui::Widget* list_;
  std::vector<nanogui::Button*> buttons_;
};

/** Joiners, their parameters, and saving, at the right. */
class JoinPanel {
 public:
  /** @param save_to where results are saved at first */
  JoinPanel(nanogui::Screen& screen, Session& session, const std::string& save_to);
  void update();
  void join();
  void saveEdits();

 private:
  void showParameters();
  void addParameter(const Parameter& parameter);
  void guarded(const std::function<void()>& action);

  nanogui::Screen& screen_;
  Session& session_;
  nanogui::Window* window_;
  nanogui::ComboBox* choice_;
  nanogui::Widget* parameters_;
  nanogui::Button *run_, *stop_;
  nanogui::TextBox* folder_;
};

/** Time and what to tell the user, at the bottom. */
class TimelinePanel {
 public:
  TimelinePanel(nanogui::Screen& screen, Session& session);
  void update();

 private:
  nanogui::Screen& screen_;
  Session& session_;
  nanogui::Window* window_;
  nanogui::Slider* slider_;
  nanogui::Label *moment_, *message_;
  std::vector<nanogui::Button*> layers_;
};

}  // namespace submap_slam
