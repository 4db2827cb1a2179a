#include <submap_slam/pipeline/finish_run.h>

#include <submap_slam/output/json_file.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/pipeline/results.h>
#include <submap_slam/pipeline/run_files.h>
#include <submap_slam/report/web_page.h>

#include <filesystem>

namespace submap_slam {

void finishRun(const Run& run, Metrics& metrics, const ReportMaker& report) {
  writeRunRecord(run.out, run.config, run.reporter.logLines());
  addRunMetrics(metrics, run.config.seed, run.reporter.warnings(), run.timer);
  if (run.config.output.report) {
    const StageTimer timer;
    const std::string input = std::filesystem::path(run.input).filename().string();
    const RunRecord record{input, iniOf(run.config), run.reporter.logLines(), metrics};
    writeText(run.out.file(kReportFile), webPage(report(record)));
    addTimedStage(metrics, "report", timer);
    addRunMetrics(metrics, run.config.seed, run.reporter.warnings(), run.timer);
  }
  writeJson(run.out.file(kMetricsFile), metrics);
}

}  // namespace submap_slam
