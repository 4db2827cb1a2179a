#include "experiment_page.h"

#include <fmt/format.h>
#include <submap_slam/core/version.h>

#include "experiment_curves.h"

namespace submap_slam {
namespace {

using Json = nlohmann::ordered_json;

/** Mean, deviation and greatest value over the seeds; null if no cell has the figure. */
Json statisticsJson(const ExperimentRow& row, const std::string& key) {
  const ErrorStatistics s = row.statistics(key);
  if (s.count == 0) return nullptr;
  return {{"count", s.count}, {"mean", s.mean}, {"std", s.std}, {"max", s.max}};
}

Json figureJson(const CellResult& cell, const std::string& key) {
  const auto figure = cell.figures.find(key);
  return figure == cell.figures.end() ? Json() : Json(figure->second);
}

Json columnJson(const ExperimentColumn& column) {
  return {{"key", column.key}, {"label", column.label}, {"decimals", column.decimals}};
}

Json rowJson(const Experiment& experiment, const ExperimentRow& row) {
  Json json{
      {"data", row.data}, {"setting", row.setting}, {"runs", row.complete()}, {"values", Json::array()}};
  for (const auto& column : experiment.columns) json["values"].push_back(statisticsJson(row, column.key));
  return json;
}

Json cellsJson(const Experiment& experiment, const std::vector<ExperimentRow>& rows) {
  Json cells = Json::array();
  for (const ExperimentRow& row : rows)
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const CellResult& cell = row.cells[i];
      Json json{
          {"data", row.data},        {"setting", row.setting}, {"seed", std::to_string(experiment.seeds[i])},
          {"error", cell.failure()}, {"build", cell.build},    {"mrpt", cell.mrpt},
          {"values", Json::array()}};
      for (const auto& column : experiment.columns) json["values"].push_back(figureJson(cell, column.key));
      cells.push_back(json);
    }
  return cells;
}

template <class Named>
Json namesOf(const std::vector<Named>& all) {
  Json names = Json::array();
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

Json seedsOf(const Experiment& experiment) {
  Json seeds = Json::array();
  for (const uint64_t seed : experiment.seeds) seeds.push_back(std::to_string(seed));
  return seeds;
}

/** "data, setting", with the column too where a plot has several. */
std::string seriesLabel(const std::string& name, const ExperimentPlot& plot, const ExperimentColumn& column) {
  return plot.y.size() == 1 ? name : fmt::format("{}, {}", name, column.label);
}

/** Over the seeds, a series for each row and column. */
Json seriesOverSeeds(const ExperimentPlot& plot, const std::vector<ExperimentRow>& rows) {
  Json series = Json::array();
  for (const ExperimentRow& row : rows)
    for (const ExperimentColumn& column : plot.y) {
      Json points = Json::array();
      for (const CellResult& cell : row.cells) {
        const Json value = figureJson(cell, column.key);
        points.push_back(value.is_null() ? value : Json{{"mean", value}, {"std", 0}});
      }
      const std::string name = fmt::format("{}, {}", row.data, row.setting);
      series.push_back({{"label", seriesLabel(name, plot, column)}, {"points", points}});
    }
  return series;
}

/** Means over the seeds, a series for each of the others and each column. Rows go by data, then settings. */
Json seriesOfMeans(const Experiment& experiment, const ExperimentPlot& plot,
                   const std::vector<ExperimentRow>& rows) {
  const std::size_t settings = experiment.settings.size();
  const bool over_data = plot.x == "data";
  const Json names = over_data ? namesOf(experiment.settings) : namesOf(experiment.data);
  Json series = Json::array();
  for (std::size_t n = 0; n < names.size(); ++n)
    for (const ExperimentColumn& column : plot.y) {
      Json points = Json::array();
      for (std::size_t r = 0; r < rows.size(); ++r)
        if ((over_data ? r % settings : r / settings) == n)
          points.push_back(statisticsJson(rows[r], column.key));
      series.push_back({{"label", seriesLabel(names[n], plot, column)}, {"points", points}});
    }
  return series;
}

/** Of the axis: the only column, or what several have in common. */
Json axisJson(const std::vector<ExperimentColumn>& columns) {
  const ExperimentColumn& first = columns.front();
  return {{"label", columns.size() == 1 ? first.label : unitOf(first)}, {"decimals", first.decimals}};
}

Json plotJson(const Experiment& experiment, const ExperimentPlot& plot,
              const std::vector<ExperimentRow>& rows) {
  Json json{{"name", plot.name}, {"title", plot.title}, {"kind", plot.kind}};
  if (plot.ofOneSeed()) {
    json["seed"] = std::to_string(plot.seed.value_or(experiment.seeds.front()));
    json["curves"] = (plot.kind == "errors" ? errorCurves : pathCurves)(experiment, plot, rows);
    return json;
  }
  json["x"] = plot.x;
  json["y"] = axisJson(plot.y);
  if (plot.x == "time") {
    json.update(timeCurves(plot, rows));
  } else if (plot.x == "seed") {
    json["places"] = seedsOf(experiment);
    json["series"] = seriesOverSeeds(plot, rows);
  } else {
    json["places"] = plot.x == "data" ? namesOf(experiment.data) : namesOf(experiment.settings);
    json["series"] = seriesOfMeans(experiment, plot, rows);
  }
  return json;
}

}  // namespace

Json experimentPage(const Experiment& experiment, const std::vector<ExperimentRow>& rows,
                    const std::string& description) {
  Json data{{"kind", "experiment"}, {"title", experiment.title}, {"version", version()}};
  data["worst"] = experiment.worst;
  data["seeds"] = seedsOf(experiment);
  data["columns"] = Json::array();
  for (const auto& column : experiment.columns) data["columns"].push_back(columnJson(column));
  data["rows"] = Json::array();
  for (const auto& row : rows) data["rows"].push_back(rowJson(experiment, row));
  data["plots"] = Json::array();
  for (const auto& plot : experiment.plots) data["plots"].push_back(plotJson(experiment, plot, rows));
  data["cells"] = cellsJson(experiment, rows);
  data["description"] = description;
  return data;
}

}  // namespace submap_slam
