#include <submap_slam/viewer/viewer_scene.h>

#include <fmt/format.h>
#include <mrpt/opengl/CEllipsoid2D.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/poses/CPose3D.h>
#include <submap_slam/viewer/grid_picture.h>
#include <Eigen/LU>
#include "landmark_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::img::TColor;
using mrpt::math::TPose2D;
using mrpt::opengl::CSetOfLines;
using mrpt::opengl::CSetOfObjects;

constexpr std::array<float, 3> kBackground{0.86f, 0.87f, 0.89f};
constexpr TColor kPath(0x20, 0x60, 0xd0), kRobot(0xd8, 0x28, 0x28), kAccepted(0x10, 0x9a, 0x40);
constexpr TColor kRejected(0xd0, 0x50, 0xa0), kByHand(0xf0, 0x80, 0x00), kSelected(0xff, 0x8c, 0x00);
constexpr TColor kAxisX(0xd0, 0x20, 0x20), kAxisY(0x18, 0xa0, 0x18), kMap(0x10, 0x10, 0x10);

/** Submaps that follow each other get colours that differ. */
constexpr std::array<TColor, 6> kWalls{TColor(0x1b, 0x4f, 0x8a), TColor(0x8a, 0x2f, 0x2f),
                                       TColor(0x1f, 0x6b, 0x3a), TColor(0x6a, 0x3d, 0x9a),
                                       TColor(0x8a, 0x5a, 0x10), TColor(0x10, 0x6a, 0x70)};

// Heights that keep what lies above on top (m).
constexpr double kMapHeight = 0.5, kLineHeight = 1, kRobotHeight = 1.5;

CSetOfLines::Ptr lines(const TColor& color, float width) {
  auto set = CSetOfLines::Create();
  set->setColor_u8(color);
  set->setLineWidth(width);
  set->enableAntiAliasing(true);
  return set;
}

void addLine(CSetOfLines& set, const TPose2D& a, const TPose2D& b, double z = kLineHeight) {
  set.appendLine(a.x, a.y, z, b.x, b.y, z);
}

CSetOfLines::Ptr trajectoryOf(const ViewerModel& model) {
  constexpr double kStep_m = 0.05;  // nearer points than that look the same
  auto path = lines(kPath, 2);
  path->setName("trajectory");
  TPose2D last;
  for (std::size_t i = 0; i < model.moments(); ++i) {
    const Moment here = model.moment(i);
    if (i > 0 && std::hypot(here.pose.x - last.x, here.pose.y - last.y) < kStep_m) continue;
    if (i > 0) addLine(*path, last, here.pose);
    last = here.pose;
  }
  return path;
}

/** Axes of each frame, x red, y green. */
void insertFrames(const ViewerModel& model, CSetOfObjects& out) {
  constexpr double kLength_m = 0.7;
  auto x_axes = lines(kAxisX, 2), y_axes = lines(kAxisY, 2);
  for (std::size_t k = 0; k < model.frames().size(); ++k) {
    if (model.hidden(k)) continue;
    const TPose2D& frame = model.frames()[k];
    addLine(*x_axes, frame, frame + TPose2D(kLength_m, 0, 0));
    addLine(*y_axes, frame, frame + TPose2D(0, kLength_m, 0));
  }
  x_axes->setName("frames");
  out.insert(x_axes);
  out.insert(y_axes);
}

/** 3-sigma ellipses of the frames. */
void insertEllipses(const ViewerModel& model, CSetOfObjects& out) {
  for (std::size_t k = 1; k < model.frames().size(); ++k) {
    const mrpt::math::CMatrixDouble22 covariance(model.joinedFrames()[k].cov.blockCopy<2, 2>(0, 0));
    const auto S = covariance.asEigen();
    if (model.hidden(k) || !S.allFinite() || S(0, 0) <= 0 || S.determinant() <= 0) continue;
    auto ellipse = mrpt::opengl::CEllipsoid2D::Create();
    ellipse->setColor_u8(model.fixed(k) ? kByHand : kAxisX);
    ellipse->setQuantiles(3);
    ellipse->setCovMatrix(covariance);
    ellipse->setLocation(model.frames()[k].x, model.frames()[k].y, kLineHeight);
    ellipse->setName("uncertainty");
    out.insert(ellipse);
  }
}

std::map<uint32_t, std::size_t> positionsOf(const GridSubmaps& submaps) {
  std::map<uint32_t, std::size_t> positions;
  for (std::size_t k = 0; k < submaps.size(); ++k) positions[submaps[k]->id] = k;
  return positions;
}

void insertConstraints(const ViewerModel& model, CSetOfObjects& out) {
  auto accepted = lines(kAccepted, 2), refused = lines(kRejected, 1), by_hand = lines(kByHand, 3),
       selected = lines(kSelected, 5);
  const auto positions = positionsOf(model.submaps());
  const auto& constraints = model.joined().constraints;
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const Constraint& c = constraints[i];
    const auto from = positions.find(c.from), to = positions.find(c.to);
    if (!c.inter || from == positions.end() || to == positions.end()) continue;
    const bool chosen = model.selectedConstraint() == i, edited = c.by_hand || model.rejected(c);
    if (!chosen && !model.shows(c.accepted ? Layer::kAccepted : Layer::kRejected)) continue;
    auto& set = chosen ? selected : edited ? by_hand : c.accepted ? accepted : refused;
    addLine(*set, model.frames()[from->second], model.frames()[to->second], kLineHeight + 0.1);
  }
  accepted->setName("accepted"), refused->setName("rejected");
  by_hand->setName("by hand"), selected->setName("selected loop");
  for (const auto& set : {refused, accepted, by_hand, selected})
    if (!set->empty()) out.insert(set);
}

/** The robot as a triangle, and what it saw. */
void insertMoment(const ViewerModel& model, CSetOfObjects& out) {
  const TPose2D robot = model.moment(model.cursor()).pose;
  auto outline = lines(kRobot, 3);
  outline->setName("robot");
  const std::array<TPose2D, 3> corners{TPose2D(0.5, 0, 0), TPose2D(-0.3, 0.3, 0), TPose2D(-0.3, -0.3, 0)};
  for (std::size_t i = 0; i < corners.size(); ++i)
    addLine(*outline, robot + corners[i], robot + corners[(i + 1) % corners.size()], kRobotHeight);
  out.insert(outline);
  if (!model.shows(Layer::kScan)) return;
  const auto placed = model.scansAtCursor();
  auto points = mrpt::opengl::CPointCloud::Create();
  points->setColor_u8(kRobot);
  points->setPointSize(3);
  points->setName("scan");
  for (const auto& scan : placed.scans)
    for (std::size_t i = 0; i < scan->getScanSize(); ++i) {
      if (!scan->getScanRangeValidity(i)) continue;
      const double range = scan->getScanRange(i), angle = scan->getScanAngle(i);
      mrpt::math::TPoint3D seen;
      scan->sensorPose.composePoint(range * std::cos(angle), range * std::sin(angle), 0, seen.x, seen.y,
                                    seen.z);
      const auto p = placed.pose.composePoint({seen.x, seen.y});
      points->insertPoint(static_cast<float>(p.x), static_cast<float>(p.y), kRobotHeight);
    }
  out.insert(points);
}

/** Path and name of the selected submap. */
void insertSelection(const ViewerModel& model, CSetOfObjects& out) {
  if (!model.selected()) return;
  const std::size_t k = *model.selected();
  auto path = lines(kSelected, 5);
  path->setName("selected");
  const auto& nodes = model.submaps()[k]->nodes;
  for (std::size_t n = 1; n < nodes.size(); ++n)
    addLine(*path, model.frames()[k] + nodes[n - 1].pose, model.frames()[k] + nodes[n].pose,
            kLineHeight + 0.05);
  out.insert(path);
  auto label = mrpt::opengl::CText::Create(
      fmt::format("{}{}{}", model.submaps()[k]->id, model.fixed(k) ? " fixed" : "",
                  model.edits().masks(model.submaps()[k]->id) ? " masked" : ""));
  label->setColor_u8(TColor(0x90, 0x30, 0x00));
  label->setLocation(model.frames()[k].x + 0.2, model.frames()[k].y + 0.2, kRobotHeight);
  out.insert(label);
}

/** Where the poses that MRPT's objects get are, at a height (m). */
mrpt::poses::CPose3D raised(const TPose2D& pose, double z) { return {pose.x, pose.y, z, pose.phi, 0, 0}; }

/** Corners of everything that is shown (m). */
struct Extent {
  double x_min = std::numeric_limits<double>::infinity(), x_max = -x_min, y_min = x_min, y_max = -x_min;

  void add(double x, double y) {
    x_min = std::min(x_min, x), x_max = std::max(x_max, x);
    y_min = std::min(y_min, y), y_max = std::max(y_max, y);
  }

  /** A point of a frame. */
  void add(const mrpt::poses::CPose2D& frame, double x, double y) {
    double x_w = 0, y_w = 0;
    frame.composePoint(x, y, x_w, y_w);
    add(x_w, y_w);
  }
};

void addGrids(Extent& extent, const ViewerModel& model) {
  for (std::size_t k = 0; k < model.submaps().size(); ++k) {
    const auto grid = model.submaps()[k]->packedEvidence();
    const mrpt::poses::CPose2D frame(model.frames()[k]);
    grid->forEachObserved([&](int cx, int cy, float, float) {
      extent.add(frame, grid->xMin() + (cx + 0.5) * grid->resolution(),
                 grid->yMin() + (cy + 0.5) * grid->resolution());
    });
  }
}

void addLandmarks(Extent& extent, const ViewerModel& model) {
  for (std::size_t k = 0; k < model.landmarkSubmaps().size(); ++k) {
    const mrpt::poses::CPose2D frame(model.frames()[k]);
    for (const auto& feature : model.landmarkSubmaps()[k]->features) extent.add(frame, feature.x, feature.y);
  }
}

}  // namespace

ViewerScene::ViewerScene()
    : scene_(mrpt::opengl::COpenGLScene::Create()),
      grids_(CSetOfObjects::Create()),
      map_(CSetOfObjects::Create()),
      landmarks_(CSetOfObjects::Create()),
      lines_(CSetOfObjects::Create()) {
  scene_->getViewport()->setCustomBackgroundColor({kBackground[0], kBackground[1], kBackground[2]});
  grids_->setName("grids");
  map_->setName("map");
  landmarks_->setName("joined landmarks");
  for (const auto& group : {grids_, map_, landmarks_, lines_}) scene_->insert(group);
}

void ViewerScene::updateGrids(const ViewerModel& model) {
  const double step = kMapHeight / static_cast<double>(model.submaps().size() + 1);
  for (std::size_t k = 0; k < model.submaps().size(); ++k) {
    const auto& submap = model.submaps()[k];
    auto& grid = grid_of_[submap];
    if (!grid) {
      grid = CSetOfObjects::Create();
      grid->setName(fmt::format("submap {}", submap->id));
      const auto evidence = submap->packedEvidence();
      if (!evidence->empty()) grid->insert(gridPicture(*evidence, kWalls[k % kWalls.size()]));
      grids_->insert(grid);
    }
    const TPose2D& frame = model.frames()[k];
    const bool on_top = model.selected() == k;
    grid->setPose(raised(frame, on_top ? kMapHeight : step * static_cast<double>(k)));
    grid->setVisibility(model.shows(Layer::kGrids) && !model.hidden(k) && !model.edits().masks(submap->id));
  }
}

void ViewerScene::updateFeatures(const ViewerModel& model) {
  for (std::size_t k = 0; k < model.landmarkSubmaps().size(); ++k) {
    const auto& submap = model.landmarkSubmaps()[k];
    auto& features = features_of_[submap];
    if (!features) {
      features = featurePicture(*submap, kWalls[k % kWalls.size()]);
      features->setName(fmt::format("landmark submap {}", submap->id));
      grids_->insert(features);
    }
    features->setPose(raised(model.frames()[k], kMapHeight));
    features->setVisibility(model.shows(Layer::kGrids));
  }
}

void ViewerScene::updateLandmarks(const ViewerModel& model) {
  const JoinedLandmarks& joined = model.joinedLandmarks();
  if (landmarks_objective_ != joined.objective) landmarks_->clear();
  landmarks_objective_ = joined.objective;
  landmarks_->setVisibility(model.shows(Layer::kMap));
  if (joined.landmarks.empty() || !landmarks_->empty()) return;
  auto picture = landmarkPicture(joined.landmarks, kMap);
  picture->setLocation(0, 0, kMapHeight + 0.1);
  landmarks_->insert(picture);
}

void ViewerScene::updateMap(const ViewerModel& model) {
  const PackedEvidence& map = model.joined().map;
  const bool same = map.storedCells() == map_cells_ && model.joined().objective == map_objective_;
  if (!same || !model.shows(Layer::kMap)) map_->clear();
  map_cells_ = 0;
  if (!model.shows(Layer::kMap)) return;
  map_cells_ = map.storedCells();
  map_objective_ = model.joined().objective;
  if (same && !map_->empty()) return;
  if (map.empty()) return;
  auto plane = gridPicture(map, kMap);
  plane->setLocation(0, 0, kMapHeight + 0.1);
  map_->insert(plane);
}

void ViewerScene::update(const ViewerModel& model) {
  updateGrids(model);
  updateMap(model);
  updateFeatures(model);
  updateLandmarks(model);
  lines_->clear();
  if (model.moments() == 0) return;
  if (model.shows(Layer::kTrajectory)) lines_->insert(trajectoryOf(model));
  if (model.shows(Layer::kFrames)) insertFrames(model, *lines_);
  if (model.shows(Layer::kEllipses)) insertEllipses(model, *lines_);
  insertConstraints(model, *lines_);
  insertSelection(model, *lines_);
  insertMoment(model, *lines_);
}

View ViewerScene::viewOfAll(const ViewerModel& model, double aspect) {
  Extent extent;
  addGrids(extent, model);
  addLandmarks(extent, model);
  for (std::size_t i = 0; i < model.moments(); ++i) {
    const TPose2D pose = model.moment(i).pose;
    extent.add(pose.x, pose.y);
  }
  if (extent.x_max < extent.x_min) return {};
  constexpr double kMargin = 1.05, kLeast_m = 2;
  const double height = std::max(extent.y_max - extent.y_min, (extent.x_max - extent.x_min) / aspect);
  return {(extent.x_min + extent.x_max) / 2, (extent.y_min + extent.y_max) / 2,
          std::max(kLeast_m, kMargin * height * std::min(1.0, aspect))};
}

}  // namespace submap_slam
