#include <submap_slam/rawlog/byte_source.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace submap_slam {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr int kGzipWindow = 15 + 16;  // zlib: largest window, gzip header and trailer

uint64_t sizeOfFile(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: no such file", file));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, expected a file", file));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file", file));
  return std::filesystem::file_size(file);
}

}  // namespace

ByteSource::ByteSource(const std::string& file, uint64_t offset)
    : file_size_(sizeOfFile(file)),
      start_(offset),
      file_position_(offset),
      packed_(kBufferBytes),
      data_(kBufferBytes) {
  file_.open(file, std::ios::binary);
  file_.seekg(static_cast<std::streamoff>(offset));
  if (!file_) throw InputError(fmt::format("{}: cannot be opened: {}", file, std::strerror(errno)));
  refillPacked();
  gzip_ = packed_left_ >= 2 && packed_[0] == 0x1f && packed_[1] == 0x8b;
  if (inflateInit2(&inflater_, kGzipWindow) != Z_OK) throw std::bad_alloc();
}

ByteSource::~ByteSource() { inflateEnd(&inflater_); }

std::size_t ByteSource::read(void* to, std::size_t count) {
  auto* out = static_cast<uint8_t*>(to);
  std::size_t done = 0;
  while (done < count && refill()) {
    const std::size_t n = std::min(count - done, data_end_ - data_begin_);
    std::memcpy(out + done, data_.data() + data_begin_, n);
    data_begin_ += n;
    position_ += n;
    done += n;
  }
  return done;
}

std::string ByteSource::peek(std::size_t count) {
  refill();
  // an object header may straddle two blocks: move the rest to the front and append
  if (data_end_ - data_begin_ < count) {
    std::memmove(data_.data(), data_.data() + data_begin_, data_end_ - data_begin_);
    data_end_ -= data_begin_;
    data_begin_ = 0;
    while (data_end_ < count && unpackBlock()) {
    }
  }
  const auto* begin = reinterpret_cast<const char*>(data_.data() + data_begin_);
  return {begin, std::min(count, data_end_ - data_begin_)};
}

bool ByteSource::atEnd() { return !refill(); }

bool ByteSource::atMemberEnd() {
  if (data_begin_ < data_end_) return !gzip_;
  if (!gzip_) return true;
  data_begin_ = data_end_ = 0;
  while (in_member_ && data_end_ == 0 && unpackBlock()) {
  }
  return !in_member_ && damage_.empty() && data_end_ == 0;
}

bool ByteSource::refill() {
  if (data_begin_ < data_end_) return true;
  data_begin_ = data_end_ = 0;
  while (data_end_ == 0 && unpackBlock()) {
  }
  return data_end_ > 0;
}

bool ByteSource::refillPacked() {
  if (packed_left_ > 0) return true;
  file_.read(reinterpret_cast<char*>(packed_.data()), static_cast<std::streamsize>(packed_.size()));
  packed_left_ = static_cast<std::size_t>(file_.gcount());
  file_position_ += packed_left_;
  inflater_.next_in = packed_.data();
  if (packed_left_ == 0 && file_.bad()) damage_ = "reading from the disk failed";
  return packed_left_ > 0;
}

/** Appends unpacked bytes to data_, which must have room, from one gzip member; false at the end of the file
 * and at damage. */
bool ByteSource::unpackBlock() {
  if (!damage_.empty()) return false;
  if (!refillPacked()) {
    truncated_ = in_member_ && damage_.empty();
    if (truncated_) damage_ = "the gzip data end in the middle";
    return false;
  }
  const std::size_t room = data_.size() - data_end_;
  if (!gzip_) {
    const std::size_t n = std::min(room, packed_left_);
    std::memcpy(data_.data() + data_end_, inflater_.next_in, n);
    inflater_.next_in += n;
    packed_left_ -= n;
    data_end_ += n;
    return true;
  }
  if (!in_member_) inflateReset(&inflater_);
  in_member_ = true;
  inflater_.avail_in = static_cast<uInt>(packed_left_);
  inflater_.next_out = data_.data() + data_end_;
  inflater_.avail_out = static_cast<uInt>(room);
  const int status = inflate(&inflater_, Z_NO_FLUSH);
  packed_left_ = inflater_.avail_in;
  data_end_ = data_.size() - inflater_.avail_out;
  if (status == Z_STREAM_END) in_member_ = false;
  if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
    damage_ = fmt::format("the gzip data are corrupt ({})", inflater_.msg ? inflater_.msg : "unknown reason");
  return damage_.empty();
}

}  // namespace submap_slam
