#pragma once

#include <submap_slam/core/grid_submap.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

namespace submap_slam {

class SpillFile;

/** Keeps evidence and scans of submaps within a budget of memory.
 *
 * What was used least recently is written to a temporary file and read again when asked for. Whatever the
 * budget, readers see the same values. Any number of threads may use submaps whose bulk is here.
 */
class SubmapStore : public std::enable_shared_from_this<SubmapStore> {
 public:
  /** How many bytes may be kept, asked whenever something was read; the argument is how many are. */
  using Budget = std::function<std::size_t(std::size_t kept_bytes)>;

  /** @param budget     what readers still hold comes on top
   * @param spill_file a temporary file beside this name takes what is dropped, uncompressed; it has no name
   * itself */
  static std::shared_ptr<SubmapStore> create(Budget budget, std::string spill_file);
  static std::shared_ptr<SubmapStore> create(std::size_t memory_bytes, std::string spill_file);
  ~SubmapStore();
  SubmapStore(const SubmapStore&) = delete;
  SubmapStore& operator=(const SubmapStore&) = delete;

  /** Takes the bulk of a submap. Not while another thread uses it. Throws OutputError if the temporary file
   * cannot be written; the submap then is as it was. */
  void takeOver(GridSubmap& submap);

  /** Memory of what is kept now. */
  std::size_t bytesKept() const;

  /** How often something was read again. */
  std::size_t timesRead() const;

 private:
  class Entry;
  using BulkPtr = std::shared_ptr<const SubmapBulk>;

  SubmapStore(Budget budget, std::string spill_file);
  BulkPtr get(const Entry& entry);
  BulkPtr findOrRead(const Entry& entry);
  BulkPtr find(const Entry& entry);
  void keep(const Entry& entry, const BulkPtr& bulk);
  void dropWhatIsTooMuch();
  void forget(const Entry& entry);
  void spill(const Entry& entry);
  BulkPtr readAgain(const Entry& entry) const;

  const Budget budget_;
  const std::string spill_file_;

  mutable std::mutex mutex_;          // guards what follows, and what the entries keep
  std::unique_ptr<SpillFile> spill_;  // once it was needed
  bool has_grown_ = false;            // since the budget was asked
  std::list<const Entry*> recent_;    // those that keep something, the most recently used first
  std::size_t bytes_kept_ = 0, times_read_ = 0;
};

}  // namespace submap_slam
