#include "experiment_plots.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cstring>

namespace submap_slam {
namespace {

void requireChoice(const IniEntry& entry, const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), entry.value) == choices.end())
    throw ConfigError(fmt::format("[{}] {} = '{}': expected {}", entry.section, entry.key, entry.value,
                                  fmt::join(choices, " or ")));
}

void setPlot(ExperimentPlot& plot, const IniEntry& entry) {
  if (entry.key == "title") {
    plot.title = entry.value;
  } else if (entry.key == "x") {
    requireChoice(entry, {"setting", "data", "seed"});
    plot.x = entry.value;
  } else if (entry.key == "y") {
    plot.y = experimentColumn(entry.value, fmt::format("[{}] y", entry.section));
  } else if (entry.key == "kind") {
    requireChoice(entry, {"bars", "lines"});
    plot.kind = entry.value;
  } else {
    throw ConfigError(
        fmt::format("unknown key [{}] {}; expected title, x, y or kind", entry.section, entry.key));
  }
}

ExperimentPlot readPlot(const ExperimentFile& file, const IniEntry& heading) {
  ExperimentPlot plot;
  plot.name = heading.section.substr(std::strlen(kPlotPrefix));
  for (const auto& entry : file.keysOf(heading.section)) file.at(entry, [&] { setPlot(plot, entry); });
  file.at(heading, [&] {
    if (plot.y.key.empty()) throw ConfigError(fmt::format("[{}]: needs y", heading.section));
  });
  if (plot.title.empty()) plot.title = plot.y.label;
  return plot;
}

}  // namespace

std::vector<ExperimentPlot> readPlots(const ExperimentFile& file,
                                      const std::vector<ExperimentColumn>& columns) {
  std::vector<ExperimentPlot> plots;
  for (const auto& entry : file.entries())
    if (entry.key.empty() && startsWith(entry.section, kPlotPrefix)) plots.push_back(readPlot(file, entry));
  if (!plots.empty()) return plots;
  for (const auto& column : columns) {
    ExperimentPlot plot;
    plot.name = column.key;
    plot.title = column.label;
    plot.y = column;
    plots.push_back(plot);
  }
  return plots;
}

}  // namespace submap_slam
