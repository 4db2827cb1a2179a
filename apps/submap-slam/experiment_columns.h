#pragma once

#include <string>
#include <vector>

namespace submap_slam {

/** A figure of a cell and how tables show it. */
struct ExperimentColumn {
  std::string key, label;
  int decimals;
};

/** "s" of the label "total, s"; empty if it has none. */
std::string unitOf(const ExperimentColumn& column);

/** All columns there are. */
const std::vector<ExperimentColumn>& experimentColumns();

/** The column of that key; throws ConfigError, beginning with `where`, if there is none. */
ExperimentColumn experimentColumn(const std::string& key, const std::string& where);

}  // namespace submap_slam
