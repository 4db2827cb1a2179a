#include <submap_slam/rawlog/submap_store.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/submap_log.h>

#include <filesystem>
#include <fstream>
#include <utility>

namespace submap_slam {

/** One submap's bulk, kept or not. Lives as long as the submap. */
class SubmapStore::Entry : public SubmapBulkSource {
 public:
  Entry(std::shared_ptr<SubmapStore> owner, Home where, const GridSubmap& submap)
      : store(std::move(owner)), home(std::move(where)), id(submap.id), nodes(submap.nodes.size()) {}
  ~Entry() override { store->forget(*this); }
  Entry(const Entry&) = delete;
  Entry& operator=(const Entry&) = delete;

  BulkPtr bulk() const override { return store->get(*this); }

  BulkPtr readAgain() const {
    const auto submap = SubmapLogReader(home.file, home.offset).next();
    if (!submap || submap->id != id || submap->nodes.size() != nodes)
      throw InputError(fmt::format("{}: was changed while it was in use: submap {} is no longer at byte {}",
                                   home.file, id, home.offset));
    return std::make_shared<const SubmapBulk>(submap->bulk());
  }

  const std::shared_ptr<SubmapStore> store;
  const Home home;
  const uint32_t id;
  const std::size_t nodes;
  mutable std::mutex reading;  // held by the one that reads it again, so that nobody else does

  // guarded by the store
  mutable BulkPtr kept;
  mutable std::size_t kept_bytes = 0;
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

SubmapStore::~SubmapStore() {
  std::error_code ignored;
  if (spilled_bytes_ > 0) std::filesystem::remove(spill_file_, ignored);
}

void SubmapStore::takeOver(GridSubmap& submap, const Home& home) {
  const auto entry = std::make_shared<Entry>(shared_from_this(), home, submap);
  keep(*entry, std::make_shared<const SubmapBulk>(submap.bulk()));
  submap.storeAway(entry);
}

void SubmapStore::takeOver(GridSubmap& submap) { takeOver(submap, spill(submap)); }

SubmapStore::Home SubmapStore::spill(const GridSubmap& submap) {
  const auto member = gzipMember(submap);
  Home home{spill_file_, spilled_bytes_};
  std::ofstream out(spill_file_, spilled_bytes_ == 0 ? std::ios::binary : std::ios::binary | std::ios::app);
  out.write(reinterpret_cast<const char*>(member.data()), static_cast<std::streamsize>(member.size()));
  out.close();
  spilled_bytes_ += member.size();
  if (!out) throw OutputError(fmt::format("{}: cannot be written", spill_file_));
  return home;
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
  if (auto bulk = find(entry)) return bulk;
  const std::lock_guard<std::mutex> reading(entry.reading);
  if (auto bulk = find(entry)) return bulk;
  BulkPtr bulk = entry.readAgain();
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

/** Makes the bulk the most recently used and drops what is too much. */
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
  const std::size_t budget = budget_(bytes_kept_);
  while (bytes_kept_ > budget) {
    const Entry& oldest = *recent_.back();
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
