#include "no_frames.h"

#include <fmt/format.h>

namespace submap_slam {
namespace {

/** What a frame is made of. */
std::string wanted(const ReaderParams& params) {
  if (!params.use_landmarks) return "2D laser scan";
  return params.use_scans ? "2D laser scan or landmark observation" : "landmark observation";
}

std::string contentOf(const LogReport& report) {
  std::string content;
  for (const auto& [name, count] : report.classes)
    content += fmt::format("{}{} {}", content.empty() ? "" : ", ", count, name);
  return content;
}

/** Which observations were left out because they are of no use, and why. */
std::string leftOut(const LogReport& report) {
  std::string reasons;
  const auto add = [&](uint64_t scans, const char* reason) {
    if (scans > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "; scans: " : ", ", scans, reason);
  };
  add(report.skipped_scans_tilted, "tilted by more than 5 deg");
  add(report.skipped_scans_bad, "with a senseless aperture, maximum range or sensor pose");
  add(report.skipped_scans_empty, "without beams");
  if (report.skipped_landmarks_bad > 0)
    reasons +=
        fmt::format("; landmark observations: {} with a senseless sensor pose", report.skipped_landmarks_bad);
  return reasons;
}

/** The log has what the other kind of map is made of. */
std::string forTheOtherMap(const LogReport& report, const ReaderParams& params) {
  const auto has = [&](const char* name) { return report.classes.count(name) > 0; };
  if (!params.use_landmarks && has("mrpt::obs::CObservationBearingRange"))
    return "; a map of landmarks can be made of it, a grid map needs scans";
  if (!params.use_scans && has("mrpt::obs::CObservation2DRangeScan"))
    return "; a grid map can be made of it, a map of landmarks needs their range and bearing";
  return "";
}

}  // namespace

std::string whyNoFrames(const LogReport& report, const ReaderParams& params) {
  if (report.file_bytes == 0) return "the file is empty, expected a rawlog";
  if (report.entries == 0) return "holds no object, expected a rawlog";
  if (report.classes.count("submap_slam::GridSubmap") > 0)
    return fmt::format("holds submaps, for 'submap-slam info' and 'join'; expected a rawlog with a {}",
                       wanted(params));
  if (!params.from.empty() || !params.to.empty())
    return fmt::format("no usable {} from '{}' to '{}'; {} entries were read ({})", wanted(params),
                       params.from, params.to, report.entries, contentOf(report));
  if (report.skipped_scans_label + report.skipped_landmarks_label > 0) {
    std::string found;
    for (const auto& [label, count] : report.skipped_labels)
      found += fmt::format("{}'{}'", found.empty() ? "" : ", ", label);
    return fmt::format("no {} with [reader] sensor_labels = {} and landmark_labels = {}; the log has {}",
                       wanted(params), params.sensor_labels, params.landmark_labels, found);
  }
  return fmt::format("no usable {}; the file holds {}{}{}", wanted(params), contentOf(report),
                     leftOut(report), forTheOtherMap(report, params));
}

}  // namespace submap_slam
