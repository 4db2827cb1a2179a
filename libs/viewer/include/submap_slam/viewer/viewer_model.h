#pragma once

#include <mrpt/math/TPose2D.h>
#include <submap_slam/core/edits.h>
#include <submap_slam/core/frame.h>
#include <submap_slam/core/joined_landmarks.h>
#include <submap_slam/core/joined_map.h>

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace submap_slam {

/** What can be shown or not. */
enum class Layer { kGrids, kMap, kTrajectory, kFrames, kEllipses, kAccepted, kRejected, kScan };
constexpr std::size_t kLayers = 8;
const char* toString(Layer layer);

/** A moment of the timeline: one scan of the log, or one pose of the path of landmark submaps. */
struct Moment {
  mrpt::Clock::time_point stamp;
  mrpt::math::TPose2D pose;           ///< T_w_robot as shown now (m, rad)
  std::optional<std::size_t> submap;  ///< position of the submap it belongs to
  std::size_t node = 0;               ///< its node there; without submaps the position in the log or path
};

/** What the viewer shows and what its user has done to it: content, timeline, selection, layers, edits. It
 * knows nothing of windows. Submaps are named by their position in the sequence, edits by their ids. */
class ViewerModel {
 public:
  ViewerModel();

  // Content
  /** A log without submaps; it is shown along its odometry. */
  void setLog(std::vector<Frame> frames);

  /** Landmark submaps and nothing else; they are shown along the chain of their end poses. */
  void setLandmarks(LandmarkSubmaps submaps);

  /** What a joiner made of the landmark submaps. Throws std::invalid_argument unless there is one frame more
   * than submaps. */
  void setJoinedLandmarks(JoinedLandmarks joined);

  /** More submaps behind those that are here; they follow the chain from the last frame. */
  void addSubmaps(const GridSubmaps& more);

  /** What joiners made of the submaps. Frames fewer than the submaps are completed along the chain; throws
   * std::invalid_argument if they are more. */
  void setJoined(JoinedMap joined);

  /** Frames on the way to a result, T_w_s; other numbers than that of the submaps are ignored. */
  void setFrames(const std::vector<mrpt::math::TPose2D>& frames);

  bool empty() const { return log_.empty() && submaps_.empty() && landmark_submaps_.empty(); }
  const std::vector<Frame>& log() const { return log_; }
  const GridSubmaps& submaps() const { return submaps_; }
  const JoinedMap& joined() const { return joined_; }
  const LandmarkSubmaps& landmarkSubmaps() const { return landmark_submaps_; }
  const JoinedLandmarks& joinedLandmarks() const { return joined_landmarks_; }

  /** T_w_s of the submaps as shown now; of landmark submaps, and where the last one ends. */
  const std::vector<mrpt::math::TPose2D>& frames() const { return frames_; }

  /** The same with covariances, as the joiners left them. */
  const std::vector<mrpt::poses::CPosePDFGaussian>& joinedFrames() const {
    return landmark_submaps_.empty() ? joined_.frames : joined_landmarks_.frames;
  }

  // Timeline
  std::size_t moments() const;
  std::size_t cursor() const { return cursor_; }
  void setCursor(std::size_t moment);
  void moveCursor(long steps);
  Moment moment(std::size_t position) const;

  /** Scans of the last moment at or before the cursor that has some, with T_w_robot there. */
  struct PlacedScans {
    mrpt::math::TPose2D pose;
    SubmapScans scans;
  };
  PlacedScans scansAtCursor() const;

  // Selection
  std::optional<std::size_t> selected() const { return selected_; }
  void select(std::optional<std::size_t> submap);
  void selectNext(int steps);

  /** Selects the visible submap whose path passes nearest to a point of the map (m), if within `reach`. */
  void selectAt(double x, double y, double reach);

  /** Position among joined().constraints. */
  std::optional<std::size_t> selectedConstraint() const { return selected_constraint_; }

  /** The next loop closure of the selected submap, or of all if none is selected. */
  void selectNextConstraint();

  // What is shown
  bool shows(Layer layer) const { return layers_.count(layer) > 0; }
  void toggle(Layer layer);
  bool hidden(std::size_t submap) const { return hidden_.count(submap) > 0; }
  void toggleHidden();  ///< the selected submap
  void showAll() { hidden_.clear(); }

  // Edits, for the next joining
  const Edits& edits() const { return edits_; }
  void setEdits(Edits edits) { edits_ = std::move(edits); }
  void toggleFix();     ///< the selected submap where it is now; not the first one
  void toggleMask();    ///< the selected submap
  void toggleReject();  ///< the selected loop closure
  bool fixed(std::size_t submap) const;
  bool rejected(const Constraint& constraint) const;

  /** The edits file that says the same. */
  std::string editsText() const;

  /** One line on the moment and the selection. */
  std::string status() const;

 private:
  void toggleEdit(Edit::Kind kind, uint32_t from, uint32_t to, const std::string& line);

  std::vector<Frame> log_;
  GridSubmaps submaps_;
  std::vector<std::size_t> first_moment_;  // of each submap, and their number
  JoinedMap joined_;
  LandmarkSubmaps landmark_submaps_;
  JoinedLandmarks joined_landmarks_;
  Trajectory landmark_path_;
  std::vector<mrpt::math::TPose2D> frames_;
  std::size_t cursor_ = 0;
  std::optional<std::size_t> selected_, selected_constraint_;
  std::set<Layer> layers_;
  std::set<std::size_t> hidden_;
  Edits edits_;
};

}  // namespace submap_slam
