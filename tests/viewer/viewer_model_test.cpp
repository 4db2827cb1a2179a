#include <submap_slam/viewer/viewer_model.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/graph_file.h>
#include <submap_slam/output/landmark_files.h>
#include <submap_slam/output/run_tables.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <submap_slam/rawlog/submap_log.h>
#include <submap_slam/viewer/viewer_source.h>

#include <fstream>

#include "../support/temp_folder.h"
#include "sample_model.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using ::testing::HasSubstr;

TEST(ViewerModel, TimelineRunsThroughTheSubmaps) {
  ViewerModel model = sampleModel();
  ASSERT_EQ(model.moments(), 16u);
  model.setCursor(6);
  const Moment moment = model.moment(6);
  EXPECT_EQ(moment.submap, 1u);
  EXPECT_EQ(moment.node, 2u);
  EXPECT_DOUBLE_EQ(moment.pose.x, 6);
  model.moveCursor(-100);
  EXPECT_EQ(model.cursor(), 0u);
  model.setCursor(1000);
  EXPECT_EQ(model.cursor(), 15u);
}

TEST(ViewerModel, ShowsTheLastScanThatWasKept) {
  ViewerModel model = sampleModel();
  model.setCursor(7);  // node 3 of submap 1 is no key node
  const auto placed = model.scansAtCursor();
  EXPECT_EQ(placed.scans.size(), 1u);
  EXPECT_DOUBLE_EQ(placed.pose.x, 6);
}

TEST(ViewerModel, LogWithoutSubmapsIsShownAlongItsOdometry) {
  ViewerModel model;
  EXPECT_EQ(model.status(), "nothing to show yet");
  Frame frame;
  frame.odometry = TPose2D(3, 4, 0);
  model.setLog({Frame(), frame});
  EXPECT_EQ(model.moments(), 2u);
  EXPECT_DOUBLE_EQ(model.moment(1).pose.y, 4);
  EXPECT_FALSE(model.moment(1).submap);
}

TEST(ViewerModel, LandmarkSubmapsFollowTheirEndPosesUntilTheyAreJoined) {
  ViewerModel model;
  model.setLandmarks(landmarkSubmaps(3));
  EXPECT_FALSE(model.empty());
  ASSERT_EQ(model.frames().size(), 4u);  // and where the last one ends
  EXPECT_DOUBLE_EQ(model.frames()[2].x, 20);
  EXPECT_NEAR(model.joinedFrames()[2].cov(0, 0), 0.02, 1e-9);
  ASSERT_EQ(model.moments(), 3u);
  EXPECT_EQ(model.cursor(), 2u);
  EXPECT_DOUBLE_EQ(model.moment(2).pose.x, 30);
  EXPECT_TRUE(model.scansAtCursor().scans.empty());
  EXPECT_THAT(model.status(), HasSubstr("pose 3 of 3"));
  EXPECT_THAT(model.status(), HasSubstr("3 landmark submaps, 0 landmarks joined"));

  JoinedLandmarks joined = model.joinedLandmarks();
  joined.frames[3].mean = mrpt::poses::CPose2D(30, 5, 0);
  joined.landmarks.resize(4);
  model.setJoinedLandmarks(joined);
  EXPECT_DOUBLE_EQ(model.moment(2).pose.y, 5);
  EXPECT_THAT(model.status(), HasSubstr("4 landmarks joined"));
  joined.frames.pop_back();
  EXPECT_THROW(model.setJoinedLandmarks(joined), std::invalid_argument);
}

TEST(ViewerModel, FramesOnTheWayMoveTheMomentsUntilTheResult) {
  ViewerModel model = sampleModel();
  model.setFrames({{0, 0, 0}, {4, 1, 0}, {8, 2, 0}, {12, 3, 0}});
  EXPECT_DOUBLE_EQ(model.moment(4).pose.y, 1);
  model.setFrames({{0, 0, 0}});  // of another number of submaps
  EXPECT_DOUBLE_EQ(model.moment(4).pose.y, 1);
  model.setJoined(chainSubmaps(model.submaps()));
  EXPECT_DOUBLE_EQ(model.moment(4).pose.y, 0);
}

TEST(ViewerModel, NewSubmapsHangOnToTheLastFrame) {
  ViewerModel model;
  const GridSubmaps submaps = straightSubmaps(3);
  model.addSubmaps({submaps[0], submaps[1]});
  JoinedMap joined = chainSubmaps(model.submaps());
  joined.frames[1].mean = mrpt::poses::CPose2D(4, 1, M_PI / 2);
  model.setJoined(joined);
  model.addSubmaps({submaps[2]});
  EXPECT_NEAR(model.frames()[2].x, 4, 1e-12);
  EXPECT_NEAR(model.frames()[2].y, 5, 1e-12);
}

TEST(ViewerModel, ClickSelectsTheNearestVisibleSubmap) {
  ViewerModel model = sampleModel();
  model.selectAt(9.1, 0.5, 2);
  EXPECT_EQ(model.selected(), 2u);
  model.toggleHidden();
  model.selectAt(9.1, 0.5, 3);
  EXPECT_EQ(model.selected(), 1u);  // its last node is 2.2 m away
  model.selectAt(9.1, 50, 2);
  EXPECT_FALSE(model.selected());
}

TEST(ViewerModel, SelectionGoesAround) {
  ViewerModel model = sampleModel();
  model.selectNext(1);
  EXPECT_EQ(model.selected(), 0u);
  model.selectNext(-1);
  EXPECT_EQ(model.selected(), 3u);
  model.selectNext(1);
  EXPECT_EQ(model.selected(), 0u);
}

TEST(ViewerModel, LoopsOfTheSelectedSubmapThatAreShown) {
  ViewerModel model = sampleModel();
  model.select(3);
  model.selectNextConstraint();
  EXPECT_EQ(model.selectedConstraint(), 2u);  // 0-3 was rejected, such are not shown at first
  model.toggle(Layer::kRejected);
  model.selectNextConstraint();
  EXPECT_EQ(model.selectedConstraint(), 1u);
  EXPECT_THAT(model.status(), HasSubstr("loop 0 - 3: rejected, no overlap"));
}

TEST(ViewerModel, EditsAreThoseOfAnEditsFile) {
  ViewerModel model = sampleModel();
  model.select(2);
  model.toggleFix();
  model.select(1);
  model.toggleMask();
  model.selectNextConstraint();
  model.toggleReject();
  EXPECT_EQ(model.editsText(), "fix 2 8.0000 0.0000 0.00000\nmask 1\nreject 1 3\n");
  EXPECT_NO_THROW(checkEdits(model.edits(), model.submaps()));
  EXPECT_TRUE(model.fixed(2));
  EXPECT_TRUE(model.rejected(model.joined().constraints[2]));

  const TempFolder folder;
  std::ofstream(folder.file("edits.txt")) << model.editsText();
  EXPECT_EQ(readEdits(folder.file("edits.txt")).list.size(), 3u);

  model.toggleReject();
  model.toggleMask();
  EXPECT_EQ(model.editsText(), "fix 2 8.0000 0.0000 0.00000\n");
}

TEST(ViewerModel, TheFirstSubmapIsFixedAnyhow) {
  ViewerModel model = sampleModel();
  model.select(0);
  model.toggleFix();
  EXPECT_TRUE(model.edits().list.empty());
}

TEST(ViewerSource, FilesOfLandmarkSubmapsAreShown) {
  const TempFolder folder;
  writeLandmarkText(folder.file("submaps.txt"), landmarkSubmaps(3));
  ViewerModel model;
  EXPECT_EQ(openInto(model, folder.file("submaps.txt")), "");
  EXPECT_EQ(model.landmarkSubmaps().size(), 3u);
}

TEST(ViewerSource, LandmarkRunsAreShownWhereTheJoinerPutThem) {
  const TempFolder folder;
  const LandmarkSubmaps submaps = landmarkSubmaps(3);
  {
    std::ofstream out(folder.file("landmark_submaps.rawlog"), std::ios::binary);
    for (const auto& submap : submaps) {
      const std::string bytes = gzipMember(*submap);
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
  }
  ViewerModel model;
  EXPECT_THAT(openInto(model, folder.file("")), HasSubstr("holds no finished result"));
  EXPECT_DOUBLE_EQ(model.frames().back().y, 0) << "not joined yet: the chain";

  JoinedLandmarks joined;
  joined.frames.resize(4);
  joined.frames[3].mean = mrpt::poses::CPose2D(27, 3, 0.25);
  joined.frames[3].cov.setDiagonal(0.5);
  joined.landmarks = {{7, 1.5, -2, {}, 4}, {8, 3, 4, {}, 5}};
  joined.landmarks[1].covariance(0, 1) = joined.landmarks[1].covariance(1, 0) = 0.125;
  writeFrames(folder.file("frames.csv"), submaps, joined);
  writeLandmarks(folder.file("landmarks.csv"), joined.landmarks);
  EXPECT_THAT(openInto(model, folder.file("")), HasSubstr("holds no finished result"))
      << "frames of an earlier run";
  EXPECT_DOUBLE_EQ(model.frames().back().y, 0);
  std::ofstream(folder.file("metrics.json")) << "{}";
  EXPECT_EQ(openInto(model, folder.file("")), "");
  ASSERT_EQ(model.frames().size(), 4u);
  EXPECT_EQ(model.frames()[0], TPose2D(0, 0, 0));
  EXPECT_EQ(model.frames()[3], TPose2D(27, 3, 0.25));
  EXPECT_EQ(model.joinedFrames()[3].cov(1, 1), 0.5);
  ASSERT_EQ(model.joinedLandmarks().landmarks.size(), 2u);
  EXPECT_EQ(model.joinedLandmarks().landmarks[1].covariance(1, 0), 0.125);
  EXPECT_EQ(model.joinedLandmarks().landmarks[1].hits, 5u);

  for (const uint32_t frames : {2, 4}) {
    const auto others = landmarkSubmaps(frames);
    joined.frames.resize(frames + 1);
    writeFrames(folder.file("frames.csv"), others, joined);
    EXPECT_THAT(openInto(model, folder.file("")),
                HasSubstr("holds " + std::to_string(frames) + " frames, expected those of 3 submaps"));
    EXPECT_DOUBLE_EQ(model.frames().back().y, 0) << "the chain";
  }
}

TEST(ViewerSource, WhatIsNoLogIsRefused) {
  ViewerModel model;
  EXPECT_THROW(openInto(model, "/nowhere.rawlog"), InputError);
  const TempFolder folder;
  EXPECT_THROW(openInto(model, folder.file("")), InputError);  // no run
  std::ofstream(folder.file("a.rawlog")) << "no rawlog";
  EXPECT_THROW(openInto(model, folder.file("a.rawlog")), InputError);
}

TEST(RunTables, FramesAndConstraintsComeBack) {
  const TempFolder folder;
  const ViewerModel model = sampleModel();
  writeFrames(folder.file("frames.csv"), model.joined().frames);
  const auto frames = readFrames(folder.file("frames.csv"));
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_EQ(frames[3].mean.x(), model.joined().frames[3].mean.x());
  EXPECT_NEAR(frames[3].cov(1, 2), model.joined().frames[3].cov(1, 2), 1e-9);
  writeConstraints(folder.file("constraints.csv"), model.joined().constraints);
  const auto constraints = readConstraints(folder.file("constraints.csv"));
  ASSERT_EQ(constraints.size(), 3u);
  EXPECT_EQ(constraints[1].to, 3u);
  EXPECT_FALSE(constraints[1].accepted);
  EXPECT_EQ(constraints[1].reason, "no overlap");
}

TEST(RunTables, DamagedLineIsNamed) {
  const TempFolder folder;
  std::ofstream(folder.file("frames.csv")) << "submap,x_m\n0,1,2\n";
  try {
    readFrames(folder.file("frames.csv"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("frames.csv:2: has too few columns"));
  }
}

}  // namespace
}  // namespace submap_slam
