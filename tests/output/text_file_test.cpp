#include <gtest/gtest.h>
#include <submap_slam/output/text_file.h>

#include "../support/temp_folder.h"

namespace submap_slam {

TEST(TextFile, HoldsTheTextByteForByte) {
  const TempFolder folder;
  for (const std::string text : {"", "no end of line", "a\n\nb\r\n", "\xC2\xB1 1 \xE2\x80\x93\n"}) {
    writeText(folder.file("a.txt"), text);
    EXPECT_EQ(readAll(folder.file("a.txt")), text);
  }
}

}  // namespace submap_slam
