#pragma once

#include <submap_slam/viewer/join_worker.h>
#include <submap_slam/viewer/viewer_model.h>
#include <submap_slam/viewer/viewer_source.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viewer_options.h"

namespace submap_slam {

/** A key that switches a layer. */
struct LayerKey {
  char key;
  Layer layer;
};
const std::vector<LayerKey>& layerKeys();

/** The model with what works on it, for a window or a picture. */
class Session {
 public:
  explicit Session(const ViewerOptions& options);

  ViewerModel& model() { return model_; }
  Configuration& configuration() { return *config_; }

  /** Names to choose from: the chain first, then each joiner of grid submaps. Of landmark submaps, the joiner
   * of the configuration first, then each that joins them. */
  std::vector<std::string> joinerNames() const;

  /** Parameters of that choice; those of the chain are those of all its joiners. */
  std::vector<const Parameter*> parametersOf(std::size_t choice) const;

  /** The chain from the end poses, or one joiner from the frames of now; landmark submaps are always joined
   * from their end poses. Throws ConfigError for parameters that contradict each other. */
  void join(std::size_t choice);
  void stopJoining() { worker_.stop(); }
  bool joining() const { return worker_.busy(); }

  /** Lets news into the model: of the run that is followed and of the joining; true if anything changed. */
  bool update();

  /** What to tell the user beside the model's own line. */
  const std::string& message() const { return message_; }
  void say(std::string text) { message_ = std::move(text); }

  /** Writes all results to a new or empty folder, as `submap-slam join` does. Throws OutputError or
   * ConfigError. */
  void saveResults(const std::string& folder);
  void saveEdits(const std::string& file);

 private:
  JoinerChain joinersOf(std::size_t choice) const;
  std::shared_ptr<LandmarkJoiner> landmarkJoinerOf(std::size_t choice) const;
  std::vector<std::string> sectionsOf(std::size_t choice) const;
  bool ofLandmarks() const { return !model_.landmarkSubmaps().empty(); }
  void take(JoinNews news);

  std::unique_ptr<Configuration> config_;
  ViewerModel model_;
  JoinWorker worker_;
  std::optional<RunFollower> follower_;
  GridSubmaps joined_submaps_;  // those the result is of: without what was masked
  std::string message_;
  std::vector<std::string> log_;
};

}  // namespace submap_slam
