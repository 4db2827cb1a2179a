#include "panels.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/pipeline/printable.h>

#include <algorithm>

namespace submap_slam {
namespace {

using nanogui::Alignment;
using nanogui::Orientation;
using nanogui::Vector2i;

constexpr int kGap = 6;  // pixels
constexpr int kFont = 15;

nanogui::Window* panel(nanogui::Screen& screen, const std::string& title, const Vector2i& at,
                       const Vector2i& size) {
  auto* window = new nanogui::Window(&screen, title);
  window->setPosition(at);
  window->setFixedSize(size);
  window->setLayout(new nanogui::BoxLayout(Orientation::Vertical, Alignment::Fill, kGap, kGap));
  return window;
}

/** A part of a panel that scrolls; the widget that is returned takes the content. */
nanogui::Widget* scrolling(nanogui::Widget* parent, int height, nanogui::Layout* layout) {
  auto* scroll = parent->add<nanogui::VScrollPanel>();
  scroll->setFixedHeight(height);
  auto* content = scroll->add<nanogui::Widget>();
  content->setLayout(layout);
  return content;
}

void clear(nanogui::Widget& widget) {
  while (widget.childCount() > 0) widget.removeChild(0);
}

/** As much of a text as fits into a line of the window. */
std::string cut(const std::string& text, int width) {
  constexpr int kCharacterWidth = 7;
  const auto fits = static_cast<std::size_t>(std::max(20, width / kCharacterWidth));
  const std::string line = printable(text);
  return line.size() <= fits ? line : line.substr(0, fits - 3) + "...";
}

std::string entryOf(const ViewerModel& model, std::size_t k) {
  const GridSubmap& submap = *model.submaps()[k];
  std::string text =
      fmt::format("{:>3}   {:>4} scans  {:5.1f} m", submap.id, submap.nodes.size(), submap.pathLength());
  if (model.fixed(k)) text += "  fixed";
  if (model.edits().masks(submap.id)) text += "  masked";
  if (model.hidden(k)) text += "  hidden";
  return text;
}

}  // namespace

SubmapPanel::SubmapPanel(nanogui::Screen& screen, Session& session) : screen_(screen), session_(session) {
  const int height = screen.height() - kTimelineHeight;
  window_ = panel(screen, "Submaps", {0, 0}, {kListWidth, height});
  list_ =
      scrolling(window_, height - 50, new nanogui::BoxLayout(Orientation::Vertical, Alignment::Fill, 2, 2));
}

void SubmapPanel::update() {
  ViewerModel& model = session_.model();
  const bool grown = buttons_.size() != model.submaps().size();
  while (buttons_.size() < model.submaps().size()) {
    const std::size_t k = buttons_.size();
    auto* button = list_->add<nanogui::Button>(" ");
    button->setFontSize(kFont);
    button->setFixedHeight(22);
    button->setCallback(
        [&model, k] { model.select(model.selected() == k ? std::nullopt : std::optional(k)); });
    buttons_.push_back(button);
  }
  for (std::size_t k = 0; k < buttons_.size(); ++k) {
    buttons_[k]->setCaption(entryOf(model, k));
    buttons_[k]->setBackgroundColor(model.selected() == k ? nanogui::Color(200, 110, 0, 255)
                                                          : nanogui::Color(70, 70, 70, 255));
  }
  if (grown) screen_.performLayout();
}

JoinPanel::JoinPanel(nanogui::Screen& screen, Session& session, const std::string& save_to)
    : screen_(screen), session_(session) {
  const int height = screen.height() - kTimelineHeight;
  window_ = panel(screen, "Join", {screen.width() - kJoinWidth, 0}, {kJoinWidth, height});
  choice_ = window_->add<nanogui::ComboBox>(session.joinerNames());
  choice_->setFontSize(kFont);
  choice_->setCallback([this](int) { guarded([this] { showParameters(); }); });
  parameters_ = scrolling(window_, height - 250,
                          new nanogui::GridLayout(Orientation::Horizontal, 2, Alignment::Fill, 2, 2));
  auto* row = window_->add<nanogui::Widget>();
  row->setLayout(new nanogui::GridLayout(Orientation::Horizontal, 2, Alignment::Fill, 0, kGap));
  run_ = row->add<nanogui::Button>("Join (j)");
  run_->setCallback([this] { join(); });
  stop_ = row->add<nanogui::Button>("Stop (Esc)");
  stop_->setCallback([this] { session_.stopJoining(); });
  folder_ = window_->add<nanogui::TextBox>(save_to);
  folder_->setEditable(true);
  folder_->setAlignment(nanogui::TextBox::Alignment::Left);
  folder_->setTooltip("Folder for the results; new or empty");
  window_->add<nanogui::Button>("Save results")->setCallback([this] {
    guarded([this] { session_.saveResults(folder_->value()); });
  });
  window_->add<nanogui::Button>("Save edits (e)")->setCallback([this] { saveEdits(); });
  showParameters();
}

void JoinPanel::guarded(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    session_.say(error.what());
  }
}

void JoinPanel::join() {
  guarded([this] { session_.join(static_cast<std::size_t>(choice_->selectedIndex())); });
}

void JoinPanel::saveEdits() {
  guarded([this] { session_.saveEdits(folder_->value() + ".edits.txt"); });
}

void JoinPanel::showParameters() {
  clear(*parameters_);
  for (const Parameter* parameter : session_.parametersOf(static_cast<std::size_t>(choice_->selectedIndex())))
    addParameter(*parameter);
  screen_.performLayout();
}

void JoinPanel::addParameter(const Parameter& parameter) {
  constexpr int kNameWidth = 165, kValueWidth = 125;
  auto* name =
      parameters_->add<nanogui::Label>(parameter.key + (parameter.unit.empty() ? "" : ", " + parameter.unit));
  name->setFixedWidth(kNameWidth);
  name->setFontSize(kFont);
  name->setTooltip(parameter.description);
  auto* value = parameters_->add<nanogui::TextBox>(parameter.value());
  value->setFixedSize({kValueWidth, 22});
  value->setFontSize(kFont);
  value->setEditable(true);
  value->setCallback([this, section = parameter.section, key = parameter.key](const std::string& text) {
    bool taken = false;
    guarded([&] {
      if (session_.joining()) throw ConfigError("parameters can be changed when the joiner has ended");
      session_.configuration().table.set(section, key, text);
      session_.say(fmt::format("{}.{} = {}", section, key, text));
      taken = true;
    });
    return taken;
  });
}

void JoinPanel::update() {
  run_->setEnabled(!session_.joining());
  stop_->setEnabled(session_.joining());
}

TimelinePanel::TimelinePanel(nanogui::Screen& screen, Session& session) : screen_(screen), session_(session) {
  const int width = screen.width();
  window_ = panel(screen, "", {0, screen.height() - kTimelineHeight}, {width, kTimelineHeight});
  auto* row = window_->add<nanogui::Widget>();
  row->setLayout(new nanogui::BoxLayout(Orientation::Horizontal, Alignment::Middle, 0, kGap));
  for (const LayerKey& key : layerKeys()) {
    auto* button = row->add<nanogui::Button>(fmt::format("{} ({})", toString(key.layer), key.key));
    button->setFontSize(kFont);
    button->setFlags(nanogui::Button::ToggleButton);
    button->setChangeCallback([this, layer = key.layer](bool on) {
      if (session_.model().shows(layer) != on) session_.model().toggle(layer);
    });
    layers_.push_back(button);
  }
  row->add<nanogui::Label>("    h: help")->setFontSize(kFont);
  slider_ = window_->add<nanogui::Slider>();
  slider_->setFixedHeight(18);
  slider_->setCallback([this](float share) {
    ViewerModel& model = session_.model();
    model.setCursor(static_cast<std::size_t>(share * static_cast<float>(model.moments())));
  });
  moment_ = window_->add<nanogui::Label>(" ");
  message_ = window_->add<nanogui::Label>(" ");
  for (nanogui::Label* label : {moment_, message_}) label->setFontSize(kFont);
}

void TimelinePanel::update() {
  const ViewerModel& model = session_.model();
  for (std::size_t i = 0; i < layers_.size(); ++i) layers_[i]->setPushed(model.shows(layerKeys()[i].layer));
  if (model.moments() > 1)
    slider_->setValue(static_cast<float>(model.cursor()) / static_cast<float>(model.moments() - 1));
  moment_->setCaption(cut(model.status(), screen_.width()));
  message_->setCaption(cut(session_.message().empty() ? " " : session_.message(), screen_.width()));
}

}  // namespace submap_slam
