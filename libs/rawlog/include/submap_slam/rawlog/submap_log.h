#pragma once

#include <submap_slam/core/joined_map.h>
#include <submap_slam/core/landmark_submap.h>
#include <submap_slam/rawlog/resume_state.h>
#include <submap_slam/rawlog/submap_store.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace submap_slam {

class DurableFile;

/** Reads the submaps of a file one by one: gzip as SubmapLogWriter writes it, or any rawlog of GridSubmap
 * objects. */
class SubmapLogReader {
 public:
  /** Throws InputError if the file does not exist or is no file.
   * @param offset where to start, from validBytes() of another reader */
  explicit SubmapLogReader(const std::string& file, uint64_t offset = 0);
  ~SubmapLogReader();
  SubmapLogReader(SubmapLogReader&&) noexcept;
  SubmapLogReader& operator=(SubmapLogReader&&) noexcept;

  /** The next submap, or null at the end. Throws InputError naming file, entry and offset if what follows is
   * damaged or something else than a submap. */
  GridSubmap::Ptr next();

  /** Size of the part of the file, from its start, that is known to hold whole submaps: those returned so
   * far, if their gzip member ended with them. */
  uint64_t validBytes() const;

  /** Share of the file that was read, in [0, 1]. */
  double fractionRead() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/** Reads a file of submaps while it is written. */
class SubmapFollower {
 public:
  /** @param store takes evidence and scans; null: they stay in memory */
  explicit SubmapFollower(std::string file, std::shared_ptr<SubmapStore> store = nullptr);

  /** The submaps that are new since the last call, unloaded; not while one is being written. Throws as
   * SubmapLogReader. */
  GridSubmaps readNew();

 private:
  std::string file_;
  std::shared_ptr<SubmapStore> store_;
  uint64_t bytes_read_ = 0;
};

/** All submaps of a file, unloaded (read their evidence with LoadedEvidence, their scans with
 * GridSubmap::scans). Throws InputError if it is damaged, empty or holds something else; the text names the
 * offset and how many submaps before it are valid.
 * @param store takes evidence and scans; null: they stay in memory */
GridSubmaps readSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store = nullptr);

/** What can be used of a file of submaps. */
struct RecoveredSubmaps {
  GridSubmaps submaps;
  uint64_t valid_bytes = 0;  ///< size of the part of the file that holds them
  std::string damage;        ///< what is wrong behind that part; empty: nothing
};

/** The submaps before the first damage, unloaded. Throws InputError only if the file cannot be opened.
 * @param store as for readSubmaps */
RecoveredSubmaps recoverSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store = nullptr);

/** Writes submaps to a file that is a rawlog, each as a gzip member of its own, and keeps the state to resume
 * from beside it.
 *
 * After each stretch its submaps are on disk (fsync), then the side-car says so; a kill at any time loses
 * only the stretch being built. Same submaps, same bytes, however often the run was interrupted: resuming
 * drops what the side-car does not vouch for. Not for use by several threads at once.
 *
 * The file is locked as long as the writer lives; a second writer of it, in whatever process, is refused.
 *
 * Every write that fails throws OutputError naming the file.
 */
class SubmapLogWriter {
 public:
  /** Starts a new file; one that exists is replaced. Of `run` only the identity counts. */
  SubmapLogWriter(std::string file, const ResumeState& run);

  /** Continues the file of a run that was interrupted, or starts a new one if there is no side-car.
   * Throws InputError if the side-car belongs to another run (naming the first difference) or the file does
   * not hold what the side-car says. Nothing is changed in a complete file. */
  static SubmapLogWriter resume(const std::string& file, const ResumeState& run);

  ~SubmapLogWriter();
  SubmapLogWriter(SubmapLogWriter&&) noexcept;
  SubmapLogWriter& operator=(SubmapLogWriter&&) noexcept;

  /** Appends the submaps of the next stretch, in order; the list may be empty. A file has submaps of one
   * form.
   */
  void appendStretch(const GridSubmaps& submaps);
  void appendLandmarkStretch(const LandmarkSubmaps& submaps);

  /** Marks the file as complete in the side-car. */
  void finish();

  /** How far the file is: stretches and submaps done, bytes written. */
  const ResumeState& state() const { return state_; }

 private:
  explicit SubmapLogWriter(std::string file);
  void start(const ResumeState& run);
  template <class Submaps>
  void append(const Submaps& submaps);

  std::string file_;
  ResumeState state_;
  std::unique_ptr<DurableFile> out_;
};

/** One serialized object as a gzip member; the same object always gives the same bytes. */
std::string gzipMember(const mrpt::serialization::CSerializable& object);

}  // namespace submap_slam
