/** One function for each form; what they share is said at importFile(). */
#pragma once

#include <submap_slam/import/import.h>

#include <string>

namespace submap_slam {

/** What every import is given, and its report. */
struct ImportJob {
  const std::string& file;
  const std::string& output;
  const ImportOptions& options;
  const ProgressCallback& progress;
  ImportReport& report;
};

void importCarmen(const ImportJob& job);
void importScanText(const ImportJob& job);
void importLandmarks(const ImportJob& job);
void importGraph(const ImportJob& job);
void importBag(const ImportJob& job);

/** True for the first word of a header line of scan text. */
bool isScanTextKey(std::string_view word);

/** True for the first word of a line of a 2D pose graph. */
bool isGraphKeyword(std::string_view word);

}  // namespace submap_slam
