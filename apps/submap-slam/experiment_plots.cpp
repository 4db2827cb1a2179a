#include "experiment_plots.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cstring>

#include "common_options.h"

namespace submap_slam {
namespace {

void requireChoice(const IniEntry& entry, const std::vector<std::string>& choices) {
  if (std::find(choices.begin(), choices.end(), entry.value) == choices.end())
    throw ConfigError(fmt::format("[{}] {} = '{}': expected {}", entry.section, entry.key, entry.value,
                                  fmt::join(choices, " or ")));
}

void setColumns(ExperimentPlot& plot, const IniEntry& entry) {
  for (const auto& key : wordsOf(entry.value))
    plot.y.push_back(experimentColumn(key, fmt::format("[{}] y", entry.section)));
  for (const auto& column : plot.y)
    if (unitOf(column) != unitOf(plot.y.front()))
      throw ConfigError(fmt::format("[{}] y: {} and {} have different units", entry.section,
                                    plot.y.front().key, column.key));
}

void setPlot(ExperimentPlot& plot, const IniEntry& entry, const std::vector<uint64_t>& seeds) {
  if (entry.key == "title") {
    plot.title = entry.value;
  } else if (entry.key == "x") {
    requireChoice(entry, {"setting", "data", "seed", "time"});
    plot.x = entry.value;
  } else if (entry.key == "y") {
    setColumns(plot, entry);
  } else if (entry.key == "kind") {
    requireChoice(entry, {"bars", "lines", "errors", "path"});
    plot.kind = entry.value;
  } else if (entry.key == "seed") {
    plot.seed = parseSeed(entry.value, fmt::format("[{}] seed", entry.section));
    if (std::find(seeds.begin(), seeds.end(), *plot.seed) == seeds.end())
      throw ConfigError(
          fmt::format("[{}] seed = {}: is none of [experiment] seeds", entry.section, *plot.seed));
  } else {
    throw ConfigError(
        fmt::format("unknown key [{}] {}; expected title, x, y, kind or seed", entry.section, entry.key));
  }
}

/** Throws ConfigError for keys that do not go together. */
void checkPlot(const ExperimentPlot& plot, const std::string& section) {
  const auto require = [&](bool fits, const char* text) {
    if (!fits) throw ConfigError(fmt::format("[{}]: {}", section, text));
  };
  if (plot.ofOneSeed()) {
    require(plot.x.empty() && plot.y.empty(), "kind = errors and kind = path have neither x nor y");
    return;
  }
  require(!plot.seed, "seed is for kind = errors and kind = path");
  require(!plot.y.empty(), "needs y");
  if (plot.x != "time") return;
  require(plot.kind == "lines", "x = time needs kind = lines");
  require(plot.y.size() == 1 && (plot.y[0].key == "ci_frames" || plot.y[0].key == "nees_frames"),
          "x = time needs y = ci_frames or y = nees_frames");
}

std::string usualTitle(const ExperimentPlot& plot) {
  if (plot.kind == "errors") return "Errors and their bounds";
  if (plot.kind == "path") return "Paths";
  std::vector<std::string> labels;
  for (const auto& column : plot.y) labels.push_back(column.label);
  return fmt::format("{}", fmt::join(labels, "; "));
}

void complete(ExperimentPlot& plot) {
  if (plot.x.empty() && !plot.ofOneSeed()) plot.x = "setting";
  if (plot.title.empty()) plot.title = usualTitle(plot);
}

ExperimentPlot readPlot(const ExperimentFile& file, const IniEntry& heading,
                        const std::vector<uint64_t>& seeds) {
  ExperimentPlot plot;
  plot.name = heading.section.substr(std::strlen(kPlotPrefix));
  for (const auto& entry : file.keysOf(heading.section)) file.at(entry, [&] { setPlot(plot, entry, seeds); });
  file.at(heading, [&] { checkPlot(plot, heading.section); });
  complete(plot);
  return plot;
}

}  // namespace

std::vector<ExperimentPlot> readPlots(const ExperimentFile& file,
                                      const std::vector<ExperimentColumn>& columns,
                                      const std::vector<uint64_t>& seeds) {
  std::vector<ExperimentPlot> plots;
  for (const auto& entry : file.entries())
    if (entry.key.empty() && startsWith(entry.section, kPlotPrefix))
      plots.push_back(readPlot(file, entry, seeds));
  if (!plots.empty()) return plots;
  for (const auto& column : columns) {
    ExperimentPlot plot;
    plot.name = column.key;
    plot.y = {column};
    complete(plot);
    plots.push_back(plot);
  }
  return plots;
}

}  // namespace submap_slam
