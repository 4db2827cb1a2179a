#pragma once

#include <mrpt/serialization/CSerializable.h>
#include <zlib.h>

#include <string>

namespace submap_slam {

/** Writes objects to a gzip-compressed rawlog as they come; the same objects give the same bytes. Errors are
 * OutputError naming the file. */
class RawlogOutput {
 public:
  /** Replaces the file. */
  explicit RawlogOutput(const std::string& file);
  ~RawlogOutput();
  RawlogOutput(const RawlogOutput&) = delete;
  RawlogOutput& operator=(const RawlogOutput&) = delete;

  void write(const mrpt::serialization::CSerializable& object);

  /** Everything is with the file system when it returns. */
  void close();

 private:
  [[noreturn]] void fail() const;

  std::string file_;
  gzFile out_;
};

}  // namespace submap_slam
