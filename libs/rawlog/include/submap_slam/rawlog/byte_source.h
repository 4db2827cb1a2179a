#pragma once

#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace submap_slam {

/** The bytes of a file in order, unpacked if it is gzip (with any number of members). */
class ByteSource {
 public:
  /** @param offset byte of the file to start from; in gzip where a member begins
   * Throws InputError if the file cannot be opened or is a folder. */
  explicit ByteSource(const std::string& file, uint64_t offset = 0);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /** Copies up to `count` bytes; fewer only at the end of the file or at damage. */
  std::size_t read(void* to, std::size_t count);

  /** The next bytes without using them up, at most `count` and at most what the next block of data holds. */
  std::string peek(std::size_t count);

  /** True if there is nothing more to read, at the end of the file and at damage. */
  bool atEnd();

  /** What is wrong with the packing; empty: nothing so far. */
  const std::string& damage() const { return damage_; }

  /** True if the damage is that the file ends too early. */
  bool truncated() const { return truncated_; }

  /** Unpacked bytes used so far. */
  uint64_t position() const { return position_; }

  /** Bytes of the file on disk used so far; in gzip up to one buffer ahead of position(). */
  uint64_t filePosition() const { return gzip_ ? file_position_ - packed_left_ : start_ + position_; }

  bool isGzip() const { return gzip_; }
  uint64_t fileSize() const { return file_size_; }

  /** True if the bytes used so far are all that a front part of the file holds: always in a plain file, at
   * the end of a member (with its checksum right) in gzip. That part is filePosition() bytes long. */
  bool atMemberEnd();

 private:
  bool refill();
  bool refillPacked();
  bool unpackBlock();

  std::ifstream file_;
  uint64_t file_size_ = 0, start_ = 0, file_position_ = 0, position_ = 0;
  bool gzip_ = false, in_member_ = false, truncated_ = false;
  std::vector<uint8_t> packed_, data_;
  std::size_t packed_left_ = 0, data_begin_ = 0, data_end_ = 0;
  z_stream inflater_{};
  std::string damage_;
};

}  // namespace submap_slam
