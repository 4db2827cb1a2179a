#include "summary.h"

#include <fmt/format.h>
#include <submap_slam/pipeline/run_files.h>

#include <filesystem>

namespace submap_slam {
namespace {

std::string inFolder(const std::string& folder, const char* file) {
  return (std::filesystem::path(folder) / file).string();
}

std::string resources(const Metrics& m) {
  return fmt::format("{:.1f} s, {:.1f} s CPU, {:.0f} MB", m["wall_s"].get<double>(), m["cpu_s"].get<double>(),
                     m["peak_memory_mb"].get<double>());
}

/** Nothing where no joiner looked for any. */
std::string loopClosures(const Metrics& m) {
  const int accepted = m["constraints_accepted"].get<int>(), rejected = m["constraints_rejected"].get<int>();
  if (accepted + rejected == 0) return "";
  return fmt::format(", {} of {} loop closures accepted", accepted, accepted + rejected);
}

std::string howToGoOn(const std::string& submap_file) {
  return fmt::format(
      "stopped; what was complete is in {}\ngive the same command again to go on, or join what is there:"
      " submap-slam join {} -o OUTDIR",
      submap_file, submap_file);
}

std::string mapSoFar(std::size_t submaps, const std::string& folder) {
  if (submaps == 0) return "";
  return fmt::format("\nmap of the first {} submaps: {}", submaps, inFolder(folder, "map.png"));
}

/** The line that says where the report is; nothing if there is none. */
std::string reportLine(const Metrics& metrics, const std::string& folder) {
  return metrics.contains("report_wall_s") ? "\nreport: " + inFolder(folder, kReportFile) : "";
}

}  // namespace

std::string mapSummary(const RunSummary& summary, const std::string& folder) {
  const Metrics& m = summary.metrics;
  if (!m.contains("join_status"))
    return howToGoOn(inFolder(folder, kSubmapFile)) + mapSoFar(summary.submaps_in_map, folder);
  std::string text = fmt::format("{} submaps, {} key nodes, {} frames\n", m["submaps"].get<int>(),
                                 m["key_nodes"].get<int>(), m["frames"].get<int>());
  text += fmt::format("joined: {} ({}){}\n", m["join_status"].get<std::string>(),
                      m["join_reason"].get<std::string>(), loopClosures(m));
  text += resources(m) + "\n";
  if (summary.interrupted)
    text += fmt::format(
        "stopped while joining, the map is the best until then; to join again: submap-slam join {} -o "
        "OUTDIR\n",
        inFolder(folder, kSubmapFile));
  return text + "map: " + inFolder(folder, "map.png") + reportLine(m, folder);
}

std::string landmarkSummary(const RunSummary& summary, const std::string& folder) {
  const Metrics& m = summary.metrics;
  return fmt::format(
      "{} submaps with {} features, {} landmarks\njoined: {} ({}), objective {:.6g}\n{}\nmap: {}{}",
      m["submaps"].get<int>(), m["features"].get<int>(), m["landmarks"].get<int>(),
      m["join_status"].get<std::string>(), m["join_reason"].get<std::string>(), m["objective"].get<double>(),
      resources(m), inFolder(folder, "map.png"), reportLine(m, folder));
}

std::string buildSummary(const RunSummary& summary, const std::string& submap_file) {
  if (summary.interrupted) return howToGoOn(submap_file);
  const Metrics& m = summary.metrics;
  return fmt::format("{} submaps from {} frames\n{}\nsubmaps: {}", m["submaps"].get<int>(),
                     m["frames"].get<int>(), resources(m), submap_file);
}

ExitCode exitCodeOf(const RunSummary& summary) {
  if (summary.interrupted) return kInterrupted;
  if (summary.failed) return kFailure;
  return summary.damaged ? kDamagedLog : kSuccess;
}

}  // namespace submap_slam
