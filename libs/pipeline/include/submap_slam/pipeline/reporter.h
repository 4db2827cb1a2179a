#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <string>
#include <vector>

namespace submap_slam {

/** What a run tells its user, and how the user stops it. This one keeps the lines for log.txt and shows
 * nothing; programs derive one that shows.
 *
 * The kept lines hold no times and no paths of results, so log.txt is the same for equal runs. Only
 * stopRequested() may be called from several threads.
 */
class Reporter {
 public:
  Reporter() = default;
  virtual ~Reporter() = default;
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;

  /** How far a stage is.
   * @param fraction share of the stage that is done, [0, 1]
   * @param units    how much of it was done in all, with the name of the unit; 0: nothing to count */
  virtual void progress(const std::string& stage, double fraction, std::size_t units = 0,
                        const std::string& unit = "");

  /** A line for the user that is not kept. */
  virtual void note(const std::string& line);

  /** Shows a warning that is not kept. */
  virtual void showWarning(const std::string& line);

  /** True once the user wants the run to end soon, with a valid partial result. */
  virtual bool stopRequested() const { return false; }

  /** True if the user watches submaps move while they are joined. */
  virtual bool showsFrames() const { return false; }

  /** T_w_s of each submap as an iteration left them (m, rad). */
  virtual void frames(const std::vector<mrpt::math::TPose2D>& T_w_s);

  /** Keeps a line for log.txt. */
  void log(const std::string& line) { log_.push_back(line); }

  /** Shows a warning and keeps it. */
  void warning(const std::string& line);

  const std::vector<std::string>& logLines() const { return log_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::vector<std::string> log_, warnings_;
};

}  // namespace submap_slam
