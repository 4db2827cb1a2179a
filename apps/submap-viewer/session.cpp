#include "session.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/json_file.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/pipeline/pipeline.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/run_files.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace submap_slam {

const std::vector<LayerKey>& layerKeys() {
  static const std::vector<LayerKey> keys{
      {'g', Layer::kGrids},    {'m', Layer::kMap},      {'t', Layer::kTrajectory}, {'f', Layer::kFrames},
      {'u', Layer::kEllipses}, {'l', Layer::kAccepted}, {'r', Layer::kRejected},   {'s', Layer::kScan}};
  return keys;
}

Session::Session(const ViewerOptions& options) : config_(loadConfiguration(options.configuration)) {
  if (!options.follow.empty()) {
    follower_.emplace(options.follow);
  } else {
    message_ = openInto(model_, options.source);
  }
  if (!options.edits_file.empty()) {
    Edits edits = readEdits(options.edits_file);
    checkEdits(edits, model_.submaps());
    model_.setEdits(std::move(edits));
  }
  for (const char key : options.layers) {
    const auto found = std::find_if(layerKeys().begin(), layerKeys().end(),
                                    [key](const LayerKey& k) { return k.key == key; });
    if (found == layerKeys().end())
      throw ConfigError(fmt::format("--toggle: '{}' is no layer; expected some of gmtfulrs", key));
    model_.toggle(found->layer);
  }
}

namespace {

/** Those of the joiners that join such submaps. */
template <class Kind>
std::vector<std::shared_ptr<Kind>> joinersOfKind(const Configuration& config) {
  std::vector<std::shared_ptr<Kind>> joiners;
  for (const auto& joiner : config.joiners)
    if (auto of_kind = std::dynamic_pointer_cast<Kind>(joiner)) joiners.push_back(std::move(of_kind));
  return joiners;
}

}  // namespace

std::vector<std::string> Session::joinerNames() const {
  const auto& [landmark_joiner, chain] = std::tie(config_->joining.landmark_joiner, config_->joining.chain);
  std::vector<std::string> names{ofLandmarks() ? "landmarks: " + landmark_joiner
                                               : "chain: " + (chain.empty() ? "none" : chain)};
  if (ofLandmarks())
    for (const auto& joiner : joinersOfKind<LandmarkJoiner>(*config_)) names.push_back(joiner->name());
  else
    for (const auto& joiner : joinersOfKind<SubmapJoiner>(*config_)) names.push_back(joiner->name());
  return names;
}

JoinerChain Session::joinersOf(std::size_t choice) const {
  if (choice == 0) return config_->joinerChain();
  const auto joiner = joinersOfKind<SubmapJoiner>(*config_).at(choice - 1);
  joiner->validate();
  return {joiner};
}

std::shared_ptr<LandmarkJoiner> Session::landmarkJoinerOf(std::size_t choice) const {
  if (choice == 0) return config_->landmarkJoiner();
  auto joiner = joinersOfKind<LandmarkJoiner>(*config_).at(choice - 1);
  joiner->validate();
  return joiner;
}

std::vector<std::string> Session::sectionsOf(std::size_t choice) const {
  if (ofLandmarks()) return {landmarkJoinerOf(choice)->name()};
  std::vector<std::string> sections;
  for (const auto& joiner : joinersOf(choice)) sections.push_back(joiner->name());
  return sections;
}

std::vector<const Parameter*> Session::parametersOf(std::size_t choice) const {
  std::vector<const Parameter*> parameters;
  for (const std::string& section : sectionsOf(choice))
    for (const Parameter& parameter : config_->table.parameters())
      if (parameter.section == section) parameters.push_back(&parameter);
  return parameters;
}

void Session::join(std::size_t choice) {
  if (worker_.busy()) return;
  if (ofLandmarks())
    return worker_.start(LandmarkJoinTask{model_.landmarkSubmaps(), landmarkJoinerOf(choice)});
  if (model_.submaps().empty()) throw ConfigError("there are no submaps to join");
  JoinTask task{model_.submaps(), model_.edits(), joinersOf(choice), mapMaker(*config_), {}};
  if (choice > 0) task.from = model_.joined();
  joined_submaps_ = maskSubmaps(task.submaps, task.edits);
  worker_.start(std::move(task));
}

bool Session::update() {
  const bool more = follower_ && !worker_.busy() && follower_->update(model_);
  if (!worker_.busy()) return more;
  take(worker_.takeNews());
  return true;
}

void Session::take(JoinNews news) {
  if (!news.stage.empty()) message_ = fmt::format("{}: {:.0f} %", news.stage, 100 * news.fraction);
  if (news.frames) model_.setFrames(*news.frames);
  if (!news.error.empty()) message_ = "not joined: " + news.error;
  if (news.landmarks) {
    message_ = fmt::format("joined: {} ({})", toString(news.landmarks->status), news.landmarks->reason);
    model_.setJoinedLandmarks(std::move(*news.landmarks));
  }
  if (!news.outcome) return;
  log_ = std::move(news.log);
  message_ = fmt::format("joined: {} ({}){}", toString(news.outcome->map.status), news.outcome->map.reason,
                         news.outcome->stopped ? ", stopped" : "");
  model_.setJoined(std::move(news.outcome->map));
}

void Session::saveResults(const std::string& folder) {
  if (ofLandmarks()) throw ConfigError("submap-slam join writes the results of landmark submaps");
  if (joined_submaps_.empty() || worker_.busy())
    throw ConfigError("join the submaps first; then the result can be saved");
  const OutputDirectory out(folder, false);
  Metrics metrics;
  addJoinMetrics(metrics, joined_submaps_, model_.joined());
  writeJoined(out, joined_submaps_, model_.joined(), metrics);
  writeRunRecord(out, *config_, log_);
  writeJson(out.file(kMetricsFile), metrics);
  saveEdits(out.file("edits.txt"));
  message_ = "saved to " + folder;
}

void Session::saveEdits(const std::string& file) {
  writeText(file, model_.editsText());
  message_ = fmt::format("{} edits saved to {}", model_.edits().list.size(), file);
}

}  // namespace submap_slam
