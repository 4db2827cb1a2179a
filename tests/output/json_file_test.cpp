#include <gtest/gtest.h>
#include <submap_slam/output/json_file.h>

#include <limits>

#include "../support/temp_folder.h"

namespace submap_slam {

TEST(WriteJson, KeepsTheOrderOfTheKeysAndTheBitsOfNumbers) {
  const TempFolder folder;
  nlohmann::ordered_json json;
  json["wall_s"] = 1.0 / 3;
  json["cpu_s"] = 2;
  json["joiners"]["grid"] = true;
  writeJson(folder.file("metrics.json"), json);
  const auto read = nlohmann::ordered_json::parse(readAll(folder.file("metrics.json")));
  EXPECT_EQ(read, json);
  EXPECT_EQ(read.begin().key(), "wall_s");
  EXPECT_EQ(read["wall_s"].get<double>(), 1.0 / 3);
}

TEST(WriteJson, NotANumberAndBrokenTextStillGiveJson) {
  const TempFolder folder;
  writeJson(folder.file("a.json"),
            {{"objective", std::numeric_limits<double>::quiet_NaN()}, {"file", "bad\xff.rawlog"}});
  const auto read = nlohmann::json::parse(readAll(folder.file("a.json")));
  EXPECT_TRUE(read["objective"].is_null());
  EXPECT_EQ(read["file"], "bad\xEF\xBF\xBD.rawlog");
}

}  // namespace submap_slam
