#pragma once

#include <mrpt/serialization/CArchive.h>
#include <submap_slam/rawlog/log_report.h>

#include <cstddef>
#include <optional>
#include <string>

#include <submap_slam/rawlog/byte_source.h>

namespace submap_slam {

/** The serialized MRPT objects of a file, one after the other. */
class ObjectStream {
 public:
  /** Throws InputError if the file cannot be opened.
   * @param offset byte of the file to start from: 0 or where an earlier stream said that it can be */
  explicit ObjectStream(const std::string& file, uint64_t offset = 0);

  /** The next object; null at the end, or where damage() then says what is wrong. */
  mrpt::serialization::CSerializable::Ptr next();

  const std::optional<LogDamage>& damage() const { return damage_; }

  /** Objects returned so far. */
  uint64_t entries() const { return entries_; }

  /** Size of the front part of the file that ends with the last object returned, at the end of a gzip member;
   * it stays where it was while members hold more than one object. */
  uint64_t validBytes() const { return valid_bytes_; }

  /** True if the file ends behind the last object, but without the proper end of its gzip member. */
  bool cutBehindLast();

  double fractionRead() const;
  uint64_t fileBytes() const { return source_.fileSize(); }
  uint64_t fileBytesRead() const { return source_.filePosition(); }

 private:
  mrpt::serialization::CSerializable::Ptr readObject();
  std::nullptr_t fail(const std::string& reason, bool truncated);

  std::string file_;
  ByteSource source_;
  uint64_t entries_ = 0, object_start_ = 0, valid_bytes_ = 0;
  bool at_member_end_ = true;  ///< behind the last object
  std::optional<LogDamage> damage_;
};

}  // namespace submap_slam
