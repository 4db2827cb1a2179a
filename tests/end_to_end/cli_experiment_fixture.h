/** An experiment and what it leaves. */
#pragma once

#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace submap_slam::testing {

class ExperimentTest : public CliTest {
 protected:
  static constexpr const char* kData =
      "[data hall]\nworld = non_convex\nsimulation.beams = 90\nsimulation.max_scans = 60\n";
  static constexpr const char* kChain = "[setting chain]\njoining.chain =\n";
  static constexpr const char* kOdometry = "[setting odometry]\nbaseline = odometry\n";

  /** An experiment with the data and settings above, and what is appended. */
  std::string experiment(const std::string& settings, const std::string& appended = "") const {
    writeFile(path("e.ini"), "[experiment]\ntitle = A test\ndata = hall\nsettings = " + settings +
                                 "\nseeds = 1, 2\ncolumns = mae_m, auc, submaps\n" + kData + kChain +
                                 kOdometry + appended);
    return path("e.ini");
  }

  std::filesystem::path result(const std::string& setting, const std::string& seed) const {
    return folder_ / "out" / "cells" / "hall" / setting / seed / "result.json";
  }

  std::string table() const { return contentOf(path("out/table.md")); }

  /** The data in the page. */
  nlohmann::json pageData() const {
    const std::string page = contentOf(path("out/experiment.html")), begin = "id=\"data\">";
    const std::size_t from = page.find(begin) + begin.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  }
};

}  // namespace submap_slam::testing
