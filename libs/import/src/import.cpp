#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/import/import.h>

#include <string_view>

#include "carmen_line.h"
#include "forms.h"
#include "text_lines.h"
#include "words.h"

namespace submap_slam {
namespace {

std::string nameOf(ImportForm form) {
  for (const auto& [name, known] : importForms())
    if (known == form) return name;
  return "";
}

/** The form of a binary file; empty: it is text. Throws InputError for one that cannot be imported. */
std::optional<ImportForm> binaryForm(const std::string& file) {
  ByteSource source(file);
  const std::string start = source.peek(64);
  if (start.empty()) throw InputError(fmt::format("{}: is empty", file));
  if (start.rfind("#ROSBAG", 0) == 0) return ImportForm::kBag;
  if (start.find('\0') == std::string::npos) return std::nullopt;
  const bool rawlog =
      start.find("CObservation") != std::string::npos || start.find("CActionCollection") != std::string::npos;
  throw InputError(fmt::format(
      "{}: is {}", file,
      rawlog ? "a rawlog already; map it as it is" : "a binary file; expected a text log or a bag"));
}

std::optional<ImportForm> formOfLine(std::string_view line) {
  Words words(line);
  const std::size_t count = words.left();
  const std::string_view first = words.next();
  if (isCarmenKeyword(first)) return ImportForm::kCarmen;
  if (isScanTextKey(first)) return ImportForm::kScans;
  if (isGraphKeyword(first)) return ImportForm::kGraph;
  const bool numbers = isNumber(first) && (count == 1 || isNumber(words.next()));
  if (numbers && (count == 1 || count == 3 || count == 4)) return ImportForm::kLandmarks;
  return std::nullopt;
}

void refuseOptions(const ImportOptions& options, ImportForm form) {
  const bool landmarks = form == ImportForm::kLandmarks;
  const auto refuse = [&](bool given, bool fits, const char* option) {
    if (given && !fits)
      throw ConfigError(fmt::format("{} does not apply to the form {}", option, nameOf(form)));
  };
  refuse(!options.odometry_file.empty(), landmarks, "--odometry");
  refuse(!options.controls_file.empty(), landmarks, "--controls");
  refuse(options.wheel_base != 0, landmarks, "--wheel-base");
  refuse(options.encoder_offset != 0, landmarks, "--encoder-offset");
  refuse(options.stamps != CarmenStamps::kAuto, form == ImportForm::kCarmen, "--stamps");
  refuse(options.beam_angles.has_value(), form == ImportForm::kCarmen || form == ImportForm::kScans,
         "--beams");
  refuse(!options.topics.empty(), form == ImportForm::kBag, "--topics");
  refuse(options.max_range.has_value(), form != ImportForm::kGraph, "--max-range");
  refuse(options.T_robot_sensor.has_value(), form != ImportForm::kGraph, "--sensor-pose");
}

void dispatch(const ImportJob& job) {
  switch (job.report.form) {
    case ImportForm::kCarmen:
      return importCarmen(job);
    case ImportForm::kScans:
      return importScanText(job);
    case ImportForm::kLandmarks:
      return importLandmarks(job);
    case ImportForm::kGraph:
      return importGraph(job);
    case ImportForm::kBag:
      return importBag(job);
  }
}

}  // namespace

const std::map<std::string, ImportForm>& importForms() {
  static const std::map<std::string, ImportForm> kForms = {{"carmen", ImportForm::kCarmen},
                                                           {"scans", ImportForm::kScans},
                                                           {"landmarks", ImportForm::kLandmarks},
                                                           {"graph", ImportForm::kGraph},
                                                           {"bag", ImportForm::kBag}};
  return kForms;
}

ImportForm recogniseForm(const std::string& file) {
  constexpr uint64_t kMostLines = 1000;
  if (const auto form = binaryForm(file)) return *form;
  TextLines lines(file);
  while (lines.number() < kMostLines && lines.next()) {
    Words words(lines.line());
    const std::string_view first = words.next();
    if (first.empty() || first.front() == '#') continue;
    if (first == "VERTEX3" || first == "EDGE3" || first.substr(0, 10) == "VERTEX_SE3" ||
        first.substr(0, 8) == "EDGE_SE3")
      throw InputError(
          fmt::format("{}:{}: is a 3D pose graph; only 2D ones are supported", file, lines.number()));
    if (const auto form = formOfLine(lines.line())) return *form;
  }
  throw InputError(
      fmt::format("{}: is none of the forms that can be imported; expected a CARMEN log, scans or landmarks "
                  "as text, a pose graph, or a ROS bag",
                  file));
}

ImportReport importFile(const std::string& file, const std::string& output, const ImportOptions& options,
                        const ProgressCallback& progress) {
  ImportReport report;
  report.form = options.form ? *options.form : recogniseForm(file);
  refuseOptions(options, report.form);
  const ProgressCallback always = progress ? progress : [](double, const std::string&) { return true; };
  dispatch({file, output, options, always, report});
  if (report.written.empty())
    throw InputError(report.damaged() ? report.damage.front()
                                      : fmt::format("{}: holds nothing that can be used", file));
  return report;
}

std::string ImportReport::asText() const {
  std::string text =
      fmt::format("form: {}{}\n", nameOf(form), lines > 0 ? fmt::format(", {} lines", lines) : "");
  for (const auto& [what, count] : written) text += fmt::format("  {:>9} {}\n", count, what);
  for (const auto& note : notes) text += "  " + note + "\n";
  for (const auto& warning : warnings) text += "  warning: " + warning + "\n";
  if (damaged_lines > 0) text += fmt::format("  {} damaged lines were left out\n", damaged_lines);
  for (const auto& line : damage) text += "  " + line + "\n";
  if (damaged_lines > damage.size()) text += "  …\n";
  return text;
}

}  // namespace submap_slam
