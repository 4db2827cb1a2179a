#include <submap_slam/viewer/viewer_scene.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/viewer/join_worker.h>
#include <submap_slam/viewer/scene_picture.h>

#include <set>
#include <thread>
#include <tuple>

#include "../support/temp_folder.h"
#include "sample_model.h"

namespace submap_slam {

/** Moves the last submap in three visible steps. */
class SteppingJoiner : public SubmapJoiner {
  DEFINE_MRPT_OBJECT(SteppingJoiner, submap_slam)

 public:
  std::string name() const override { return "stepping"; }
  std::string description() const override { return "for tests"; }
  void describe(ParameterTable&) override {}
  JoinedMap join(const GridSubmaps& submaps, const JoinedMap& initial,
                 const ProgressCallback& progress) const override {
    JoinedMap joined = initial;
    for (int step = 1; step <= 3; ++step) {
      std::vector<mrpt::math::TPose2D> frames;
      for (const auto& frame : joined.frames) frames.push_back(frame.mean.asTPose());
      frames.back().y = step;
      joined.frames.back().mean = mrpt::poses::CPose2D(frames.back());
      if (progress.showsFrames()) progress.showFrames(frames);
      if (progress && !progress(step / 3.0, "stepping")) break;
    }
    EXPECT_EQ(submaps.size(), joined.frames.size());
    joined.status = JoinStatus::kConverged;
    return joined;
  }
};

IMPLEMENTS_MRPT_OBJECT(SteppingJoiner, SubmapJoiner, submap_slam)

/** Makes a landmark of each submap. */
class CountingJoiner : public LandmarkJoiner {
  DEFINE_MRPT_OBJECT(CountingJoiner, submap_slam)

 public:
  std::string name() const override { return "counting"; }
  std::string description() const override { return "for tests"; }
  void describe(ParameterTable&) override {}
  JoinedLandmarks join(const LandmarkSubmaps& submaps, const ProgressCallback& progress) const override {
    JoinedLandmarks joined;
    joined.landmarks.resize(submaps.size());
    EXPECT_TRUE(progress(0.5, "counting"));
    return joined;
  }
};

IMPLEMENTS_MRPT_OBJECT(CountingJoiner, LandmarkJoiner, submap_slam)

namespace {

using mrpt::math::TPose2D;
using mrpt::opengl::CSetOfLines;

/** A task that makes the map by fusing the evidence of the submaps. */
JoinTask joinTask(GridSubmaps submaps, JoinerChain joiners, Edits edits = {},
                  std::optional<JoinedMap> from = {}) {
  const auto fuse = [](const GridSubmaps& joined, const JoinedMap& map, Reporter&) {
    return fuseEvidence(joined, map.frames, 0);
  };
  return {std::move(submaps), std::move(edits), std::move(joiners), fuse, std::move(from)};
}

JoinNews untilDone(JoinWorker& worker) {
  JoinNews all;
  while (worker.busy()) {
    JoinNews news = worker.takeNews();
    if (news.frames) all.frames = news.frames;
    if (news.outcome) all.outcome = std::move(news.outcome);
    if (news.landmarks) all.landmarks = std::move(news.landmarks);
    if (!news.error.empty()) all.error = news.error;
    std::this_thread::yield();
  }
  return all;
}

std::size_t linesOf(const ViewerScene& scene, const std::string& name) {
  const auto object = scene.scene()->getByName(name);
  const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(object);
  return lines ? lines->size() : 0;
}

std::pair<mrpt::math::TPoint3D, mrpt::math::TPoint3D> endsOf(const CSetOfLines& lines, std::size_t i) {
  double x0, y0, z0, x1, y1, z1;
  lines.getLineByIndex(i, x0, y0, z0, x1, y1, z1);
  return {{x0, y0, z0}, {x1, y1, z1}};
}

TEST(ViewerScene, HasWhatTheModelShows) {
  ViewerModel model = sampleModel();
  ViewerScene scene;
  scene.update(model);
  EXPECT_EQ(linesOf(scene, "trajectory"), 15u);
  EXPECT_EQ(linesOf(scene, "frames"), 4u);
  EXPECT_EQ(linesOf(scene, "accepted"), 2u);
  EXPECT_EQ(linesOf(scene, "rejected"), 0u);
  EXPECT_EQ(linesOf(scene, "robot"), 3u);
  EXPECT_TRUE(scene.scene()->getByName("submap 3")->isVisible());

  model.toggle(Layer::kRejected);
  model.toggle(Layer::kTrajectory);
  model.select(3);
  model.toggleHidden();
  model.selectNextConstraint();
  model.toggleReject();
  scene.update(model);
  EXPECT_EQ(linesOf(scene, "trajectory"), 0u);
  EXPECT_EQ(linesOf(scene, "frames"), 3u);
  EXPECT_EQ(linesOf(scene, "selected loop"), 1u);
  EXPECT_FALSE(scene.scene()->getByName("submap 3")->isVisible());
  model.select(std::nullopt);
  scene.update(model);
  EXPECT_EQ(linesOf(scene, "by hand"), 1u);
}

TEST(ViewerScene, GridsMoveWithTheirFrames) {
  ViewerModel model = sampleModel();
  ViewerScene scene;
  scene.update(model);
  const auto grid = scene.scene()->getByName("submap 2");
  model.setFrames({{0, 0, 0}, {4, 0, 0}, {8, 5, 1}, {12, 0, 0}});
  scene.update(model);
  EXPECT_EQ(scene.scene()->getByName("submap 2"), grid);
  EXPECT_DOUBLE_EQ(grid->getPoseY(), 5);
  EXPECT_DOUBLE_EQ(grid->getPoseYawRad(), 1);
}

TEST(ViewerScene, LandmarksHaveEllipsesInTheirFrames) {
  ViewerModel model;
  model.setLandmarks(landmarkSubmaps(3));
  ViewerScene scene;
  scene.update(model);
  EXPECT_EQ(linesOf(scene, "frames"), 4u);
  const auto submap = scene.scene()->getByName("landmark submap 1");
  ASSERT_TRUE(submap);
  EXPECT_DOUBLE_EQ(submap->getPoseX(), 10);
  const auto ellipses = std::dynamic_pointer_cast<CSetOfLines>(
      dynamic_cast<mrpt::opengl::CSetOfObjects&>(*submap).getByName("ellipses"));
  ASSERT_TRUE(ellipses);
  ASSERT_GT(ellipses->size(), 0u);
  for (std::size_t i = 0; i < ellipses->size(); ++i) {  // 3 sigma of 0.1 m
    const auto [first, second] = endsOf(*ellipses, i);
    const bool of_first = first.x < 5;
    EXPECT_NEAR(std::hypot(first.x - (of_first ? 0 : 10), first.y - 2), 0.3, 1e-6);
    EXPECT_NEAR(std::hypot(second.x - (of_first ? 0 : 10), second.y - 2), 0.3, 1e-6);
  }
  const View view = ViewerScene::viewOfAll(model, 2);
  EXPECT_DOUBLE_EQ(view.x, 15);
  EXPECT_DOUBLE_EQ(view.y, 1);

  JoinedLandmarks joined = model.joinedLandmarks();
  joined.frames[1].mean = mrpt::poses::CPose2D(10, 5, 0);
  joined.objective = 1;
  joined.landmarks.resize(4);
  for (auto& landmark : joined.landmarks) landmark.covariance.setIdentity();
  model.setJoinedLandmarks(joined);
  model.toggle(Layer::kGrids);
  model.toggle(Layer::kMap);
  scene.update(model);
  EXPECT_DOUBLE_EQ(submap->getPoseY(), 5);
  EXPECT_FALSE(submap->isVisible());
  const auto landmarks =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(scene.scene()->getByName("joined landmarks"));
  ASSERT_TRUE(landmarks);
  EXPECT_TRUE(landmarks->isVisible());
  EXPECT_GT(landmarks->size(), 0u);
}

TEST(ViewerScene, ViewHoldsAllSubmapsAndIsCentredOnWhatIsSeen) {
  const View view = ViewerScene::viewOfAll(sampleModel(), 2);
  EXPECT_NEAR(view.x, 8, 0.2);      // walls of x from -2 to 18
  EXPECT_NEAR(view.y, 0.775, 0.1);  // rows 20 and 35 of the grids, whose other rows nobody saw
  EXPECT_GE(view.size * 2, 20);     // the width
  EXPECT_EQ(ViewerScene::viewOfAll(ViewerModel(), 1).size, View().size);
}

TEST(ScenePicture, IsRenderedWithoutADisplay) {
  const TempFolder folder;
  ViewerScene scene;
  const ViewerModel model = sampleModel();
  scene.update(model);
  const std::string file = folder.file("a.png");
  try {
    writePicture(file, *scene.scene(), ViewerScene::viewOfAll(model, 2), 400, 200);
  } catch (const OutputError& error) {
    GTEST_SKIP() << error.what();
  }
  mrpt::img::CImage picture;
  ASSERT_TRUE(picture.loadFromFile(file));
  std::set<std::tuple<int, int, int>> colours;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 400; ++x) {
      const auto c = picture.ptr<uint8_t>(static_cast<unsigned>(x), static_cast<unsigned>(y));
      colours.emplace(c[0], c[1], c[2]);
    }
  EXPECT_GE(colours.size(), 6u);  // background, free space, walls, path, axes, robot
}

TEST(JoinWorker, ShowsFramesOnTheWayAndTheResult) {
  JoinWorker worker;
  worker.start(joinTask(straightSubmaps(3), {std::make_shared<SteppingJoiner>()}));
  EXPECT_THROW(worker.start(JoinTask{}), std::logic_error);
  const JoinNews news = untilDone(worker);
  ASSERT_TRUE(news.frames);
  EXPECT_GE(news.frames->back().y, 1);
  ASSERT_TRUE(news.outcome);
  EXPECT_DOUBLE_EQ(news.outcome->map.frames.back().mean.y(), 3);
  EXPECT_GT(news.outcome->map.map.observedCells(), 0u);
}

TEST(JoinWorker, OneJoinerGoesOnFromTheFramesOfNow) {
  JoinWorker worker;
  const GridSubmaps submaps = straightSubmaps(3);
  JoinedMap from = chainSubmaps(submaps);
  from.frames[1].mean = mrpt::poses::CPose2D(4, 0.5, 0);
  worker.start(joinTask(submaps, {std::make_shared<SteppingJoiner>()}, {}, from));
  EXPECT_DOUBLE_EQ(untilDone(worker).outcome->map.frames[1].mean.y(), 0.5);
}

TEST(JoinWorker, JoinsLandmarks) {
  JoinWorker worker;
  worker.start(LandmarkJoinTask{landmarkSubmaps(3), std::make_shared<CountingJoiner>()});
  const JoinNews news = untilDone(worker);
  ASSERT_TRUE(news.landmarks);
  EXPECT_EQ(news.landmarks->landmarks.size(), 3u);
  EXPECT_FALSE(news.outcome);
}

TEST(JoinWorker, EditsThatDoNotFitAreTold) {
  JoinWorker worker;
  Edits edits;
  edits.list.push_back(readEdit("mask 17", "viewer"));
  worker.start(joinTask(straightSubmaps(3), {}, edits));
  EXPECT_THAT(untilDone(worker).error, ::testing::HasSubstr("there is no submap 17"));
}

TEST(JoinWorker, EndsWhenItIsDestroyed) {
  JoinWorker worker;
  worker.start(joinTask(straightSubmaps(3), {std::make_shared<SteppingJoiner>()}));
}

}  // namespace
}  // namespace submap_slam
