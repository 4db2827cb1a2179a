#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/output_directory.h>

#include "../support/temp_folder.h"

namespace submap_slam {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(OutputDirectory, CreatesTheFolderWithItsParents) {
  const TempFolder folder;
  const OutputDirectory out(folder.file("a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(folder.file("a/b/c")));
  EXPECT_EQ(out.file("map.png"), folder.file("a/b/c/map.png"));
  EXPECT_EQ(out.path(), folder.file("a/b/c"));
}

TEST(OutputDirectory, TakesAnEmptyFolder) {
  const TempFolder folder;
  EXPECT_NO_THROW(OutputDirectory(folder.file("")));
}

TEST(OutputDirectory, RefusesAFolderThatHoldsSomething) {
  const TempFolder folder;
  folder.write("thesis.txt", "ten years of work");
  EXPECT_THAT([&] { OutputDirectory(folder.file("")); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr(folder.file("")), HasSubstr("--overwrite"))));
}

TEST(OutputDirectory, OverwritingLeavesWhatIsThere) {
  const TempFolder folder;
  const auto thesis = folder.write("thesis.txt", "ten years of work");
  const auto old_map = folder.write("map.png", "old");
  const OutputDirectory out(folder.file(""), true);
  EXPECT_EQ(readAll(thesis), "ten years of work");
  EXPECT_EQ(readAll(old_map), "old");
}

TEST(OutputDirectory, RefusesAFile) {
  const TempFolder folder;
  const auto file = folder.write("results", "a file");
  EXPECT_THAT([&] { OutputDirectory(file, true); }, ThrowsMessage<ConfigError>(HasSubstr(file)));
  EXPECT_THAT([&] { OutputDirectory(file + "/below", true); }, ThrowsMessage<OutputError>(HasSubstr(file)));
  EXPECT_EQ(readAll(file), "a file");
}

}  // namespace submap_slam
