#include <gtest/gtest.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/output/replace_file.h>
#include <submap_slam/output/text_file.h>

#include "../support/temp_folder.h"

namespace submap_slam {

TEST(ReplaceFile, KeepsTheOldFileUntilTheNewOneIsWhole) {
  const TempFolder folder;
  const std::string file = folder.write("a.txt", "old");
  replaceFile(file, [&](const std::string& part) {
    writeText(part, "new");
    EXPECT_EQ(readAll(file), "old");
  });
  EXPECT_EQ(readAll(file), "new");
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

TEST(ReplaceFile, KeepsTheOldFileIfWritingFails) {
  const TempFolder folder;
  const std::string file = folder.write("a.txt", "old");
  const auto fail = [](const std::string& part) {
    writeText(part, "half");
    throw OutputError("disk full");
  };
  EXPECT_THROW(replaceFile(file, fail), OutputError);
  EXPECT_EQ(readAll(file), "old");
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

TEST(ReplaceFile, SaysIfItCannotBeMoved) {
  const TempFolder folder;
  std::filesystem::create_directories(folder.file("a.txt/in_use"));
  const auto write = [](const std::string& part) { writeText(part, "new"); };
  EXPECT_THROW(replaceFile(folder.file("a.txt"), write), OutputError);
}

}  // namespace submap_slam
