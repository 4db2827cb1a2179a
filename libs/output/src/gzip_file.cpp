#include "gzip_file.h"

#include <mrpt/io/CStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/gzip.h>

#include <algorithm>
#include <stdexcept>

#include "binary_file.h"

namespace submap_slam {
namespace {

/** Compresses what is written to it into gzip members, one behind the other. */
class GzipFile : public mrpt::io::CStream {
 public:
  explicit GzipFile(const std::string& file) : out_(file) {}

  std::size_t Write(const void* bytes, std::size_t count) override {
    position_ += count;
    const char* next = static_cast<const char*>(bytes);
    for (std::size_t left = count; left > 0;) {
      const std::size_t taken = std::min(left, kPiece - piece_.size());
      piece_.append(next, taken);
      next += taken, left -= taken;
      if (piece_.size() == kPiece) flush();
    }
    return count;
  }

  void close() {
    flush();
    out_.close();
  }

  /** As BinaryFile::check. */
  void check() { out_.check(); }

  uint64_t getTotalBytesCount() const override { return position_; }
  uint64_t getPosition() const override { return position_; }
  std::size_t Read(void*, std::size_t) override { throw std::logic_error("GzipFile: is only written"); }
  uint64_t Seek(int64_t, TSeekOrigin) override { throw std::logic_error("GzipFile: is only written"); }

 private:
  static constexpr std::size_t kPiece = 1 << 20;

  void flush() {
    const std::string packed = gzip(piece_.data(), piece_.size(), GzipLevel::kUsual);
    out_.write(packed.data(), packed.size());
    piece_.clear();
  }

  BinaryFile out_;
  std::string piece_;
  uint64_t position_ = 0;
};

}  // namespace

void writeGzippedArchive(const std::string& file, const mrpt::serialization::CSerializable& object) {
  GzipFile out(file);
  try {
    mrpt::serialization::archiveFrom(out) << object;
  } catch (...) {
    out.check();  // MRPT throws another error in place of that of the file
    throw;
  }
  out.close();
}

}  // namespace submap_slam
