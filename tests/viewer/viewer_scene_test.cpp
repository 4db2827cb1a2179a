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

namespace {

using mrpt::math::TPose2D;

JoinNews untilDone(JoinWorker& worker) {
  JoinNews all;
  while (worker.busy()) {
    JoinNews news = worker.takeNews();
    if (news.frames) all.frames = news.frames;
    if (news.outcome) all.outcome = std::move(news.outcome);
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

TEST(ViewerScene, ViewHoldsAllSubmaps) {
  const View view = ViewerScene::viewOfAll(sampleModel(), 2);
  EXPECT_NEAR(view.x, 8, 0.2);   // x from -2 to 18
  EXPECT_GE(view.size * 2, 20);  // the width
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
  worker.start({straightSubmaps(3), {}, {std::make_shared<SteppingJoiner>()}, 0, {}});
  EXPECT_THROW(worker.start({}), std::logic_error);
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
  worker.start({submaps, {}, {std::make_shared<SteppingJoiner>()}, 0, from});
  EXPECT_DOUBLE_EQ(untilDone(worker).outcome->map.frames[1].mean.y(), 0.5);
}

TEST(JoinWorker, EditsThatDoNotFitAreTold) {
  JoinWorker worker;
  Edits edits;
  edits.list.push_back(readEdit("mask 17", "viewer"));
  worker.start({straightSubmaps(3), edits, {}, 0, {}});
  EXPECT_THAT(untilDone(worker).error, ::testing::HasSubstr("there is no submap 17"));
}

TEST(JoinWorker, EndsWhenItIsDestroyed) {
  JoinWorker worker;
  worker.start({straightSubmaps(3), {}, {std::make_shared<SteppingJoiner>()}, 0, {}});
}

}  // namespace
}  // namespace submap_slam
