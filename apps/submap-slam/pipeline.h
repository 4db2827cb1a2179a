/** The whole way from a rawlog to a map. */
#pragma once

#include <submap_slam/core/edits.h>
#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/local_mapper.h>
#include <submap_slam/output/output_directory.h>
#include <submap_slam/rawlog/submap_log.h>

#include <string>

#include "configuration.h"
#include "metrics.h"
#include "reporter.h"
#include "stretch_source.h"

namespace submap_slam {

/** How a run ended and what it says of itself. */
// NOLINTNEXTLINE(bugprone-exception-escape): takes asserts of the JSON library for throws
struct RunSummary {
  Metrics metrics;           ///< what metrics.json holds
  bool damaged = false;      ///< the log is damaged; the part before the damage was used
  bool interrupted = false;  ///< a stop signal ended it early
  bool failed = false;       ///< landmark submaps could not be joined; what is written is not joined
};

/** Maps a rawlog: reads frames, cuts them into stretches, builds their submaps, joins them, writes all
 * results to a folder.
 *
 * A run that was stopped or killed is continued when it is started again; its results have the same bytes as
 * those of a run that never stopped, also for any number of threads (metrics.json, which holds times,
 * excepted).
 * @param overwrite start anew in a folder that holds something
 * @param edits     applied to the joining; if they do not fit the submaps these are kept, and the same call
 * with others goes on from there */
RunSummary mapRawlog(const std::string& log, const std::string& folder, bool overwrite,
                     const Configuration& config, Reporter& reporter, const Edits& edits = {});

/** The first half of mapRawlog: submaps of a rawlog into a file. */
RunSummary buildRawlog(const std::string& log, const std::string& submap_file, bool overwrite,
                       const Configuration& config, Reporter& reporter);

/** The second half of mapRawlog: from a file of submaps to all results. */
RunSummary joinFile(const std::string& submap_file, const std::string& folder, bool overwrite,
                    const Configuration& config, Reporter& reporter, const Edits& edits = {});

/** Builds the submaps of all stretches that `writer` does not have yet, in parallel; each is on disk before
 * the progress goes on. Memory does not grow with the log. After a stop signal no stretch is begun any more;
 * returns false if it left stretches out. */
bool buildSubmaps(StretchSource& source, const LocalMapper& mapper, SubmapLogWriter& writer,
                  Reporter& reporter);

/** What joiners made of submaps. */
struct JoinOutcome {
  JoinedMap map;
  bool stopped = false;  ///< a stop signal ended a joiner early
};

/** Runs the joiners one after the other, from the chain of end poses, and makes the global map.
 * @param by_hand constraints from the user, which the joiners get with those of the chain */
JoinOutcome joinSubmaps(const GridSubmaps& submaps, const JoinerChain& joiners, double map_resolution,
                        Reporter& reporter, const std::vector<Constraint>& by_hand = {});

}  // namespace submap_slam
