#include <submap_slam/rawlog/submap_store.h>

#include <fmt/format.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>

#include <utility>
#include <vector>

#include "spill_file.h"

namespace submap_slam {
namespace {

using mrpt::serialization::CArchive;

/** Not compressed: it is read again many times. */
void writeBulk(CArchive&& out, const SubmapBulk& bulk) {
  bulk.evidence->writeTo(out);
  out << static_cast<uint64_t>(bulk.scans.size());
  for (const SubmapScans& of_node : bulk.scans) {
    out << static_cast<uint64_t>(of_node.size());
    for (const auto& scan : of_node) out << *scan;
  }
}

SubmapBulk readBulk(CArchive&& in) {
  SubmapBulk bulk;
  bulk.evidence = std::make_shared<const PackedEvidence>(PackedEvidence::readFrom(in));
  bulk.scans.resize(in.ReadAs<uint64_t>());
  for (SubmapScans& of_node : bulk.scans) {
    of_node.resize(in.ReadAs<uint64_t>());
    for (auto& scan : of_node) scan = in.ReadObject<mrpt::obs::CObservation2DRangeScan>();
  }
  return bulk;
}

}  // namespace

/** One submap's bulk, kept or not. Lives as long as the submap. */
class SubmapStore::Entry : public SubmapBulkSource {
 public:
  explicit Entry(std::shared_ptr<SubmapStore> owner) : store(std::move(owner)) {}
  ~Entry() override { store->forget(*this); }
  Entry(const Entry&) = delete;
  Entry& operator=(const Entry&) = delete;

  BulkPtr bulk() const override { return store->get(*this); }

  const std::shared_ptr<SubmapStore> store;
  mutable std::mutex reading;  // held by the one that reads it again, so that nobody else does

  // guarded by the store
  mutable BulkPtr kept;
  mutable std::size_t kept_bytes = 0;
  mutable uint64_t spilled_at = 0;                     // byte of the spill file
  mutable std::size_t spilled_bytes = 0;               // 0: it is not there
  mutable std::weak_ptr<const SubmapBulk> in_use;      // what was dropped may still be in somebody's hands
  mutable std::list<const Entry*>::iterator position;  // in the list of the store, if kept
};

SubmapStore::SubmapStore(Budget budget, std::string spill_file)
    : budget_(std::move(budget)), spill_file_(std::move(spill_file)) {}

std::shared_ptr<SubmapStore> SubmapStore::create(Budget budget, std::string spill_file) {
  return std::shared_ptr<SubmapStore>(new SubmapStore(std::move(budget), std::move(spill_file)));
}

std::shared_ptr<SubmapStore> SubmapStore::create(std::size_t memory_bytes, std::string spill_file) {
  return create([memory_bytes](std::size_t) { return memory_bytes; }, std::move(spill_file));
}

SubmapStore::~SubmapStore() = default;

void SubmapStore::takeOver(GridSubmap& submap) {
  const auto entry = std::make_shared<Entry>(shared_from_this());
  keep(*entry, std::make_shared<const SubmapBulk>(submap.bulk()));
  dropWhatIsTooMuch();
  submap.storeAway(entry);
}

/** Writes what is kept of a submap to the spill file, unless it is there already. */
void SubmapStore::spill(const Entry& entry) {
  if (entry.spilled_bytes > 0) return;
  mrpt::io::CMemoryStream bytes;
  constexpr uint64_t kGrowth = 1 << 22;
  bytes.setAllocBlockSize(kGrowth);
  writeBulk(mrpt::serialization::archiveFrom(bytes), *entry.kept);
  if (!spill_) spill_ = std::make_unique<SpillFile>(spill_file_);
  entry.spilled_at = spill_->append(bytes.getRawBufferData(), bytes.getTotalBytesCount());
  entry.spilled_bytes = bytes.getTotalBytesCount();
}

SubmapStore::BulkPtr SubmapStore::readAgain(const Entry& entry) const {
  const std::unique_ptr<char[]> bytes(new char[entry.spilled_bytes]);  // a vector would clear it first
  spill_->read(entry.spilled_at, bytes.get(), entry.spilled_bytes);
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.get(), entry.spilled_bytes);
  return std::make_shared<const SubmapBulk>(readBulk(mrpt::serialization::archiveFrom(stream)));
}

std::size_t SubmapStore::bytesKept() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return bytes_kept_;
}

std::size_t SubmapStore::timesRead() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return times_read_;
}

SubmapStore::BulkPtr SubmapStore::get(const Entry& entry) {
  BulkPtr bulk = findOrRead(entry);
  try {
    dropWhatIsTooMuch();
  } catch (const OutputError&) {
    // what is asked for is here: better too much memory than no result
  }
  return bulk;
}

SubmapStore::BulkPtr SubmapStore::findOrRead(const Entry& entry) {
  if (auto bulk = find(entry)) return bulk;
  const std::lock_guard<std::mutex> reading(entry.reading);
  if (auto bulk = find(entry)) return bulk;
  BulkPtr bulk = readAgain(entry);
  keep(entry, bulk);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++times_read_;
  return bulk;
}

SubmapStore::BulkPtr SubmapStore::find(const Entry& entry) {
  BulkPtr bulk;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    bulk = entry.kept ? entry.kept : entry.in_use.lock();
  }
  if (bulk) keep(entry, bulk);
  return bulk;
}

/** Makes the bulk the most recently used. */
void SubmapStore::keep(const Entry& entry, const BulkPtr& bulk) {
  const std::size_t bytes = bulk->bytes();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (entry.kept) {
    recent_.splice(recent_.begin(), recent_, entry.position);
    return;
  }
  recent_.push_front(&entry);
  entry.position = recent_.begin();
  entry.kept = bulk;
  entry.in_use = bulk;
  entry.kept_bytes = bytes;
  bytes_kept_ += bytes;
  has_grown_ = true;
}

void SubmapStore::dropWhatIsTooMuch() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!std::exchange(has_grown_, false)) return;
  const std::size_t budget = budget_(bytes_kept_);
  while (bytes_kept_ > budget) {
    const Entry& oldest = *recent_.back();
    spill(oldest);
    recent_.pop_back();
    bytes_kept_ -= oldest.kept_bytes;
    oldest.kept.reset();
  }
}

void SubmapStore::forget(const Entry& entry) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!entry.kept) return;
  recent_.erase(entry.position);
  bytes_kept_ -= entry.kept_bytes;
}

}  // namespace submap_slam
