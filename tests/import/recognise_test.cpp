#include <zlib.h>

#include "imported.h"

namespace submap_slam {
namespace {

using testing::HasSubstr;

ImportForm formOf(const std::string& text) {
  const TempFolder temp;
  return recogniseForm(temp.write("a.log", text));
}

TEST(RecogniseForm, ByContent) {
  EXPECT_EQ(formOf("# log\n\nPARAM robot_x 1\n"), ImportForm::kCarmen);
  EXPECT_EQ(formOf("MARKER\nRAWLASER1 0\n"), ImportForm::kCarmen);
  EXPECT_EQ(formOf("range_max 3\n"), ImportForm::kScans);
  EXPECT_EQ(formOf("1 2 3\n"), ImportForm::kLandmarks);
  EXPECT_EQ(formOf("1 2 3 4\n"), ImportForm::kLandmarks);
  EXPECT_EQ(formOf("EDGE2 0 1 0 0 0 1 0 1 1 0 0\n"), ImportForm::kGraph);
}

TEST(RecogniseForm, SaysWhatOtherFilesAre) {
  EXPECT_THAT(refusal("#ROSBAG V1.2\n"), HasSubstr("is no ROS bag of format 2.0"));
  EXPECT_THAT(refusal(std::string("\x17\x80mrpt::obs::CObservation2DRangeScan\0\0", 37)),
              HasSubstr("is a rawlog already"));
  EXPECT_THAT(refusal(std::string("\x89PNG\0\0\0", 7)), HasSubstr("is a binary file"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"), HasSubstr("a.log:1: is a 3D pose graph"));
  EXPECT_THAT(refusal("Dear diary\n"), HasSubstr("is none of the forms"));
  EXPECT_THROW(recogniseForm("/nowhere/a.log"), InputError);
}

TEST(RecogniseForm, OptionsMustFit) {
  ImportOptions options;
  options.controls_file = "c.txt";
  EXPECT_THAT(refusal("range_max 3\n", options), HasSubstr("--controls does not apply to the form scans"));
}

TEST(Import, ReadsGzipAndReportsWhereItBreaks) {
  const TempFolder temp;
  std::string text = "angle_min -1\nangle_increment 1\nrange_max 8\n";
  for (int k = 0; k < 2000; ++k)
    text += std::to_string(k) + " 0 0 0 1 " + std::to_string(k % 7 + k * 1e-3) + " 3\n";
  const gzFile out = gzopen(temp.file("a.gz").c_str(), "wb");
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  const auto whole = importFile(temp.file("a.gz"), temp.file("a.rawlog"), {}, {});
  EXPECT_EQ(whole.written.at("scans of LASER"), 2000u);
  EXPECT_FALSE(whole.damaged());

  const std::string bytes = readAll(temp.file("a.gz"));
  const auto half =
      importFile(temp.write("b.gz", bytes.substr(0, bytes.size() / 2)), temp.file("b.rawlog"), {}, {});
  EXPECT_LT(half.written.at("scans of LASER"), 2000u);
  EXPECT_GT(half.written.at("scans of LASER"), 100u);
  EXPECT_THAT(half.damage.back(), HasSubstr("the gzip data end in the middle; what follows is lost"));
}

TEST(Import, SameLogSameBytes) {
  const TempFolder temp;
  const std::string log =
      temp.write("a.log", "angle_min -1\nangle_increment 1\nrange_max 8\n1 0 0 0 1 2 3\n");
  importFile(log, temp.file("a.rawlog"), {}, {});
  importFile(log, temp.file("b.rawlog"), {}, {});
  EXPECT_EQ(readAll(temp.file("a.rawlog")), readAll(temp.file("b.rawlog")));
}

TEST(Import, StopsWhenAsked) {
  const TempFolder temp;
  std::string text = "angle_min -1\nangle_increment 1\nrange_max 8\n";
  for (int k = 0; k < 600; ++k) text += std::to_string(k) + " 0 0 0 1 2 3\n";
  const auto stop = [](double, const std::string&) { return false; };
  EXPECT_THROW(importFile(temp.write("a.log", text), temp.file("a.rawlog"), {}, stop), Interrupted);
}

TEST(Import, FullDiskIsAnError) {
  const TempFolder temp;
  const std::string log =
      temp.write("a.log", "angle_min -1\nangle_increment 1\nrange_max 8\n1 0 0 0 1 2 3\n");
  EXPECT_THROW(importFile(log, "/dev/full", {}, {}), OutputError);
  EXPECT_THROW(importFile(log, temp.file("none/a.rawlog"), {}, {}), OutputError);
}

}  // namespace
}  // namespace submap_slam
