#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/landmark_joiner.h>
#include <submap_slam/core/plugins.h>
#include <submap_slam/core/submap_joiner.h>

#include <algorithm>
#include <filesystem>

#include "../support/temp_folder.h"

namespace submap_slam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(const std::string& file) {
  try {
    loadPlugin(file);
  } catch (const PluginError& e) {
    return e.what();
  }
  ADD_FAILURE() << "no PluginError";
  return {};
}

template <class Form = SubmapJoiner>
std::shared_ptr<Form> joinerNamed(const std::string& name) {
  for (const auto& joiner : availableJoiners())
    if (joiner->name() == name) return std::dynamic_pointer_cast<Form>(joiner);
  return nullptr;
}

TEST(Plugins, ALoadedJoinerCanBeListedConfiguredAndRun) {
  loadPlugin(SAMPLE_JOINER);
  const auto joiner = joinerNamed("sample");
  ASSERT_TRUE(joiner);
  ParameterTable table;
  joiner->describe(table);
  table.set("sample.weight=0.75");
  EXPECT_EQ(joiner->join({}, {}, {}).objective, 0.75);
  EXPECT_EQ(joiner->incremental()->join({}, {}, {}).objective, 0.75);
  EXPECT_EQ(joinerNamed("sample")->join({}, {}, {}).objective, 0.25) << "every object has its own parameters";
}

TEST(Plugins, APluginMayJoinSubmapsOfBothForms) {
  loadPlugin(SAMPLE_JOINER);
  const auto joiner = joinerNamed<LandmarkJoiner>("sample_landmarks");
  ASSERT_TRUE(joiner);
  EXPECT_FALSE(joinerNamed<SubmapJoiner>("sample_landmarks"));
  EXPECT_FALSE(joinerNamed<LandmarkJoiner>("sample"));
  EXPECT_EQ(joiner->join({LandmarkSubmap::Create()}, {}).frames.size(), 2u);
}

TEST(Plugins, LoadingTwiceIsHarmless) {
  loadPlugin(SAMPLE_JOINER);
  const std::size_t count = availableJoiners().size();
  loadPlugin(SAMPLE_JOINER);
  EXPECT_EQ(availableJoiners().size(), count);
}

TEST(Plugins, JoinersAreSortedByName) {
  loadPlugin(SAMPLE_JOINER);
  const auto joiners = availableJoiners();
  EXPECT_TRUE(std::is_sorted(joiners.begin(), joiners.end(),
                             [](const auto& a, const auto& b) { return a->name() < b->name(); }));
}

TEST(Plugins, AFileThatIsNotThereIsRefusedByName) {
  EXPECT_THAT(refusal("/nowhere/none.so"), AllOf(HasSubstr("/nowhere/none.so"), HasSubstr("no such file")));
  const TempFolder temp;
  EXPECT_THAT(refusal(temp.file("")), HasSubstr("no such file"));
}

TEST(Plugins, AFileThatIsNoLibraryIsRefusedInOneLine) {
  const TempFolder temp;
  const std::string why = refusal(temp.write("text.so", "not a library"));
  EXPECT_THAT(why, AllOf(HasSubstr("text.so"), HasSubstr("cannot be loaded"), Not(HasSubstr("\n"))));
}

TEST(Plugins, ALibraryWithoutTheMarkIsRefused) {
  EXPECT_THAT(refusal(LIBRARY_WITHOUT_MARK), HasSubstr("SUBMAP_SLAM_PLUGIN()"));
}

TEST(Plugins, AnotherInterfaceVersionIsRefused) {
  EXPECT_THAT(refusal(OTHER_INTERFACE_PLUGIN), AllOf(HasSubstr("interface"), HasSubstr("rebuild")));
}

TEST(Plugins, AFolderIsLoadedWhole) {
  const TempFolder temp;
  std::filesystem::create_symlink(SAMPLE_JOINER, temp.file("linked.so"));
  temp.write("notes.txt", "not a plugin, nor named like one");
  EXPECT_NO_THROW(loadPluginFolder(temp.file("")));
  EXPECT_TRUE(joinerNamed("sample"));
  temp.write("broken.so", "");
  EXPECT_THROW(loadPluginFolder(temp.file("")), PluginError);
}

TEST(Plugins, AFolderThatIsNotThereHoldsNone) { EXPECT_NO_THROW(loadPluginFolder("/nowhere")); }

}  // namespace
}  // namespace submap_slam
