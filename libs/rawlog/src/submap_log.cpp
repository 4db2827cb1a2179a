#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/gzip.h>
#include <submap_slam/rawlog/submap_log.h>

#include <filesystem>

#include "durable_file.h"
#include "object_stream.h"

namespace submap_slam {
namespace {

bool isSubmap(const mrpt::serialization::CSerializable& object) {
  return dynamic_cast<const GridSubmap*>(&object) != nullptr ||
         dynamic_cast<const LandmarkSubmap*>(&object) != nullptr;
}

/** Throws InputError unless the file starts with the submaps that the side-car says. */
void checkFront(const std::string& file, const ResumeState& state) {
  if (state.submap_bytes == 0) return;
  const auto mismatch = [&](const std::string& why) {
    return InputError(fmt::format("{}: cannot be resumed, {} says {} submaps in {} bytes: {}", file,
                                  resumeFileOf(file), state.submaps_done, state.submap_bytes, why));
  };
  ObjectStream stream(file);
  for (uint64_t k = 0; k < state.submaps_done; ++k) {
    const auto object = stream.next();
    if (stream.damage()) throw mismatch(stream.damage()->text);
    if (!object) throw mismatch(fmt::format("the file ends after {}", k));
    if (!isSubmap(*object))
      throw mismatch(fmt::format("entry {} is a {}", k, object->GetRuntimeClass()->className));
    if (stream.cutBehindLast()) throw mismatch(fmt::format("the gzip member of entry {} is incomplete", k));
  }
  if (stream.validBytes() != state.submap_bytes)
    throw mismatch(fmt::format("they take {} bytes", stream.validBytes()));
}

/** The identity of a run without its progress. */
ResumeState newRun(const ResumeState& run) {
  ResumeState state;
  state.version = run.version;
  state.config_hash = run.config_hash;
  state.log = run.log;
  state.log_bytes = run.log_bytes;
  state.log_hash = run.log_hash;
  return state;
}

}  // namespace

struct SubmapLogReader::Impl {
  Impl(const std::string& name, uint64_t offset) : file(name), stream(name, offset), valid_bytes(offset) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{} (the {} submaps before it are valid)", what, submaps));
  }

  std::string file;
  ObjectStream stream;
  uint64_t submaps = 0, valid_bytes = 0;
};

SubmapLogReader::SubmapLogReader(const std::string& file, uint64_t offset)
    : impl_(std::make_unique<Impl>(file, offset)) {}
SubmapLogReader::~SubmapLogReader() = default;
SubmapLogReader::SubmapLogReader(SubmapLogReader&&) noexcept = default;
SubmapLogReader& SubmapLogReader::operator=(SubmapLogReader&&) noexcept = default;

GridSubmap::Ptr SubmapLogReader::next() {
  auto& stream = impl_->stream;
  const auto object = stream.next();
  if (stream.damage()) impl_->fail(stream.damage()->text);
  if (!object) return nullptr;
  auto submap = std::dynamic_pointer_cast<GridSubmap>(object);
  if (!submap)
    impl_->fail(fmt::format("{}: entry {} is a {}, expected a GridSubmap", impl_->file, stream.entries() - 1,
                            object->GetRuntimeClass()->className));
  if (stream.cutBehindLast())
    impl_->fail(fmt::format("{}: entry {}: its gzip member is incomplete or corrupt", impl_->file,
                            stream.entries() - 1));
  ++impl_->submaps;
  impl_->valid_bytes = stream.validBytes();
  return submap;
}

uint64_t SubmapLogReader::validBytes() const { return impl_->valid_bytes; }
double SubmapLogReader::fractionRead() const { return impl_->stream.fractionRead(); }

namespace {

/** All submaps of the file. */
void readAll(SubmapLogReader& reader, const std::shared_ptr<SubmapStore>& store, GridSubmaps& submaps) {
  for (;;) {
    auto submap = reader.next();
    if (!submap) return;
    if (store) store->takeOver(*submap);
    submaps.push_back(std::move(submap));
  }
}

}  // namespace

SubmapFollower::SubmapFollower(std::string file, std::shared_ptr<SubmapStore> store)
    : file_(std::move(file)), store_(std::move(store)) {}

GridSubmaps SubmapFollower::readNew() {
  SubmapLogReader reader(file_, bytes_read_);
  GridSubmaps submaps;
  readAll(reader, store_, submaps);
  bytes_read_ = reader.validBytes();
  return submaps;
}

GridSubmaps readSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store) {
  GridSubmaps submaps = SubmapFollower(file, store).readNew();
  if (submaps.empty()) throw InputError(fmt::format("{}: holds no submaps", file));
  return submaps;
}

RecoveredSubmaps recoverSubmaps(const std::string& file, const std::shared_ptr<SubmapStore>& store) {
  SubmapLogReader reader(file);
  RecoveredSubmaps recovered;
  try {
    readAll(reader, store, recovered.submaps);
  } catch (const InputError& error) {
    recovered.damage = error.what();
  }
  recovered.valid_bytes = reader.validBytes();
  return recovered;
}

SubmapLogWriter::SubmapLogWriter(std::string file)
    : file_(std::move(file)), out_(std::make_unique<DurableFile>(file_)) {}

SubmapLogWriter::SubmapLogWriter(std::string file, const ResumeState& run)
    : SubmapLogWriter(std::move(file)) {
  start(run);
}

void SubmapLogWriter::start(const ResumeState& run) {
  state_ = newRun(run);
  // a side-car of an earlier run must not vouch for the new, empty file
  std::error_code ignored;
  std::filesystem::remove(resumeFileOf(file_), ignored);
  out_->cutTo(0);
  out_->sync();
  writeResumeState(file_, state_);
}

SubmapLogWriter SubmapLogWriter::resume(const std::string& file, const ResumeState& run) {
  SubmapLogWriter writer(file);  // locked before anything is read: what follows cannot change meanwhile
  const auto state = readResumeState(file);
  if (!state) {
    writer.start(run);
    return writer;
  }
  if (const auto key = runDifference(*state, run); !key.empty())
    throw InputError(
        fmt::format("{}: cannot be resumed, it belongs to a run with {}", resumeFileOf(file), key));
  checkFront(file, *state);
  writer.state_ = *state;
  if (!state->complete) writer.out_->cutTo(state->submap_bytes);
  return writer;
}

SubmapLogWriter::~SubmapLogWriter() = default;
SubmapLogWriter::SubmapLogWriter(SubmapLogWriter&&) noexcept = default;
SubmapLogWriter& SubmapLogWriter::operator=(SubmapLogWriter&&) noexcept = default;

void SubmapLogWriter::appendStretch(const GridSubmaps& submaps) { append(submaps); }

void SubmapLogWriter::appendLandmarkStretch(const LandmarkSubmaps& submaps) { append(submaps); }

template <class Submaps>
void SubmapLogWriter::append(const Submaps& submaps) {
  if (state_.complete) throw std::logic_error("SubmapLogWriter: the file is already complete");
  for (const auto& submap : submaps) {
    const auto member = gzipMember(*submap);
    out_->append(member.data(), member.size());
    state_.submap_bytes += member.size();
    ++state_.submaps_done;
  }
  if (!submaps.empty()) out_->sync();
  ++state_.stretches_done;
  writeResumeState(file_, state_);
}

void SubmapLogWriter::finish() {
  state_.complete = true;
  writeResumeState(file_, state_);
}

std::string gzipMember(const mrpt::serialization::CSerializable& object) {
  return gzippedArchive(object, GzipLevel::kFastest);
}

}  // namespace submap_slam
