#pragma once

#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <submap_slam/viewer/viewer_model.h>

#include <map>

namespace submap_slam {

/** Where to look from above (m). */
struct View {
  double x = 0, y = 0;
  double size = 10;  ///< what the shorter side of the picture shows
};

/** The model as 3D objects, seen from above. Submaps are made once and moved afterwards. */
class ViewerScene {
 public:
  ViewerScene();

  /** Brings the objects up to date. Throws as GridSubmap::packedEvidence. */
  void update(const ViewerModel& model);

  const mrpt::opengl::COpenGLScene::Ptr& scene() const { return scene_; }

  /** A view of everything, in a picture `aspect` times as wide as high. */
  static View viewOfAll(const ViewerModel& model, double aspect);

 private:
  void updateGrids(const ViewerModel& model);
  void updateMap(const ViewerModel& model);
  void updateFeatures(const ViewerModel& model);
  void updateLandmarks(const ViewerModel& model);

  mrpt::opengl::COpenGLScene::Ptr scene_;
  mrpt::opengl::CSetOfObjects::Ptr grids_, map_, landmarks_, lines_;  // children, from below to above
  std::map<GridSubmap::Ptr, mrpt::opengl::CSetOfObjects::Ptr> grid_of_;
  std::map<LandmarkSubmap::Ptr, mrpt::opengl::CSetOfObjects::Ptr> features_of_;
  std::size_t map_cells_ = 0;  // of the map that map_ shows
  double map_objective_ = -1, landmarks_objective_ = -1;
};

}  // namespace submap_slam
