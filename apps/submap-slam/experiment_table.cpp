#include "experiment_table.h"

#include <fmt/format.h>
#include <submap_slam/core/version.h>
#include <submap_slam/output/csv_text.h>
#include <submap_slam/output/text_file.h>

#include <algorithm>
#include <set>

namespace submap_slam {
namespace fs = std::filesystem;

std::size_t ExperimentRow::complete() const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [](const auto& c) { return !c.figures.empty(); }));
}

ErrorStatistics ExperimentRow::statistics(const std::string& key) const {
  std::vector<double> values;
  for (const auto& cell : cells)
    if (const auto figure = cell.figures.find(key); figure != cell.figures.end())
      values.push_back(figure->second);
  return errorStatistics(values);
}

std::vector<ExperimentRow> readRows(const Experiment& experiment, const fs::path& folder) {
  std::vector<ExperimentRow> rows;
  for (const auto& data : experiment.data)
    for (const auto& setting : experiment.settings) {
      ExperimentRow row{data.name, setting.name, {}, ""};
      for (const uint64_t seed : experiment.seeds) {
        const CellResult cell = readCell(folder, data, setting, seed);
        row.cells.push_back(cell);
        if (!cell.failure().empty())
          row.note += fmt::format("{}seed {}: {}", row.note.empty() ? "" : "; ", seed, cell.failure());
      }
      rows.push_back(std::move(row));
    }
  return rows;
}

std::vector<std::string> buildsOf(const std::vector<ExperimentRow>& rows) {
  std::set<std::string> builds;
  for (const auto& row : rows)
    for (const auto& cell : row.cells)
      if (!cell.build.empty()) builds.insert(cell.build);
  return {builds.begin(), builds.end()};
}

namespace {

std::string markdown(const Experiment& experiment, const std::vector<ExperimentRow>& rows) {
  std::string text = fmt::format("# {}\n\n| data | setting | runs |", experiment.title);
  for (const auto& column : experiment.columns) text += fmt::format(" {} |", column.label);
  text += "\n|---|---|---|";
  for (std::size_t i = 0; i < experiment.columns.size(); ++i) text += "---|";
  for (const auto& row : rows) {
    text += fmt::format("\n| {} | {} | {} |", row.data, row.setting, row.complete());
    for (const auto& column : experiment.columns) {
      const ErrorStatistics s = row.statistics(column.key);
      if (s.count == 0) {
        text += " – |";
      } else if (s.count == 1) {
        text += fmt::format(" {:.{}f} |", s.mean, column.decimals);
      } else {
        text += fmt::format(" {:.{}f} ± {:.{}f}", s.mean, column.decimals, s.std, column.decimals);
        text += experiment.worst ? fmt::format(", ≤ {:.{}f} |", s.max, column.decimals) : " |";
      }
    }
    if (!row.note.empty()) text += fmt::format(" failed: {} |", row.note);
  }
  return text + fmt::format("\n\nMean ± standard deviation{} over seeds {}; submap-slam {}, build {}.\n",
                            experiment.worst ? " and greatest value" : "", fmt::join(experiment.seeds, ", "),
                            version(), fmt::join(buildsOf(rows), " and "));
}

std::string csv(const Experiment& experiment, const std::vector<ExperimentRow>& rows) {
  std::string text = "data,setting,runs";
  for (const auto& column : experiment.columns) {
    text += fmt::format(",{0}_mean,{0}_std", column.key);
    if (experiment.worst) text += fmt::format(",{}_max", column.key);
  }
  text += ",failed\n";
  for (const auto& row : rows) {
    text += fmt::format("{},{},{}", row.data, row.setting, row.complete());
    for (const auto& column : experiment.columns) {
      const ErrorStatistics s = row.statistics(column.key);
      text += s.count == 0 ? ",," : fmt::format(",{},{}", s.mean, s.std);
      if (experiment.worst) text += s.count == 0 ? "," : fmt::format(",{}", s.max);
    }
    text += "," + (row.note.empty() ? "" : quotedCsv(row.note)) + "\n";
  }
  return text;
}

}  // namespace

void writeTables(const Experiment& experiment, const std::vector<ExperimentRow>& rows,
                 const fs::path& folder) {
  writeText((folder / "table.md").string(), markdown(experiment, rows));
  writeText((folder / "table.csv").string(), csv(experiment, rows));
}

}  // namespace submap_slam
