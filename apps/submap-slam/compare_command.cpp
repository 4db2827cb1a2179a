#include <fmt/format.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/output/text_file.h>
#include <submap_slam/report/comparison.h>
#include <submap_slam/report/web_page.h>

#include <cstdio>
#include <memory>
#include <set>

#include "commands.h"

namespace submap_slam {
namespace {

struct CompareOptions {
  std::vector<std::string> folders;
  std::string output;
  bool overwrite = false, quiet = false;
};

/** Names of the folders, or where two have the same name their paths. */
std::vector<std::string> namesOf(const std::vector<RunFolder>& runs, const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  names.reserve(runs.size());
  for (const auto& run : runs) names.push_back(run.name);
  return std::set<std::string>(names.begin(), names.end()).size() == names.size() ? names : paths;
}

int runCompare(const CompareOptions& options) {
  std::vector<RunFolder> runs;
  for (const auto& folder : options.folders) runs.push_back(readRunFolder(folder));
  const Comparison comparison = compareRuns(runs, namesOf(runs, options.folders));
  const OutputDirectory out(options.output, options.overwrite);
  const std::string table = markdown(comparison), page = out.file("compare.html");
  writeText(out.file("compare.md"), table);
  writeText(out.file("compare.csv"), csv(comparison));
  writeText(page, webPage(comparisonPage(runs, comparison)));
  if (!options.quiet) fmt::print("{}", table);
  std::fflush(stdout);  // the table comes first where both go into one file
  if (!options.quiet) fmt::print(stderr, "page: {}\n", page);
  return kSuccess;
}

}  // namespace

void addCompareCommand(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand(
      "compare", "Puts runs side by side: maps, trajectories, figures, times and settings that differ");
  command
      ->add_option("runs", options->folders,
                   "Folders that `map` or `join` wrote; the first one is what the others are compared with")
      ->required()
      ->expected(2, 100)
      ->type_name("RUN...");
  command
      ->add_option("-o,--output", options->output,
                   "Folder for compare.html, compare.md and compare.csv; must be new or empty")
      ->required()
      ->type_name("OUTDIR");
  command->add_flag("--overwrite", options->overwrite, "Replace results that exist");
  command->add_flag("-q,--quiet", options->quiet, "Do not print the table");
  command->footer("Example: submap-slam compare run_a run_b -o comparison");
  command->callback([options, &exit_code] { exit_code = runCompare(*options); });
}

}  // namespace submap_slam
