/** The whole way from a rawlog to a map. */
#pragma once

#include <submap_slam/core/edits.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/eval/mapping_progress.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/pipeline/configuration.h>
#include <submap_slam/pipeline/metrics.h>
#include <submap_slam/pipeline/reporter.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace submap_slam {

/** How a run ended and what it says of itself. */
// NOLINTNEXTLINE(bugprone-exception-escape): takes asserts of the JSON library for throws
struct RunSummary {
  Metrics metrics;                 ///< what metrics.json holds
  bool damaged = false;            ///< the log is damaged; the part before the damage was used
  bool interrupted = false;        ///< a stop signal ended it early
  std::size_t submaps_in_map = 0;  ///< of the latest map that an incremental run wrote while it built submaps
  bool failed = false;             ///< landmark submaps could not be joined; what is written is not joined

  /** The grid submaps as they were joined, with their map, as far as joining came if it was stopped;
   * null if there are none or the run was stopped before. */
  std::shared_ptr<const JoinedMap> joined;
};

/** Maps a rawlog: reads frames, cuts them into stretches, builds their submaps in the forms that [mapping]
 * maps names, joins each form, writes all results to a folder. Where there are both, those of landmarks have
 * names that begin with `landmark_`, and metrics.json says how far the two paths are apart.
 *
 * A run that was stopped or killed is continued when it is started again; its results have the same bytes as
 * those of a run that never stopped, also for any number of threads (metrics.json, which holds times,
 * excepted).
 * @param overwrite start anew in a folder that holds something
 * @param edits     applied to the joining; if they do not fit the submaps these are kept, and the same call
 * with others goes on from there */
RunSummary mapRawlog(const std::string& log, const std::string& folder, bool overwrite,
                     const Configuration& config, Reporter& reporter, const Edits& edits = {});

/** The first half of mapRawlog: submaps of a rawlog into a file; with both forms, those of landmarks into one
 * beside it (landmarkFileBeside). */
RunSummary buildRawlog(const std::string& log, const std::string& submap_file, bool overwrite,
                       const Configuration& config, Reporter& reporter);

/** The second half of mapRawlog: from a file of submaps to all results. */
RunSummary joinFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                    const Configuration& config, Reporter& reporter, const Edits& edits = {});

/** Writes all results of a joining but the record of the run, and adds the figures that come with writing
 * them. Returns what submaps.csv says.
 * @param submaps those that the joiners got */
std::vector<SubmapProgress> writeJoined(const OutputDirectory& out, const GridSubmaps& submaps,
                                        const JoinedMap& joined, Metrics& metrics);

}  // namespace submap_slam
