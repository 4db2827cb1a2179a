#include "binary_file.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace submap_slam {
namespace {

/** Compresses in one step; zlib's gzip header has neither name nor time unless it is given them. */
std::string gzip(const void* data, std::size_t size) {
  if (size > std::numeric_limits<uInt>::max()) throw std::length_error("gzip: more than 4 GB in one piece");
  constexpr int kGzipWindowBits = 15 + 16, kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindowBits, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("gzip: cannot start");
  std::string out(deflateBound(&stream, size), '\0');
  stream.next_in = static_cast<Bytef*>(const_cast<void*>(data));
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw std::runtime_error("gzip: cannot compress");
  return out;
}

}  // namespace

void writeBytes(const std::string& file, const std::string& bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  if (out) out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  // A full disk may show only now.
  if (out) out.close();
  if (!out)
    throw OutputError(file +
                      ": cannot be written: " + (errno != 0 ? std::strerror(errno) : "unknown reason"));
}

std::string compressedArchive(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream memory;
  constexpr uint64_t kGrowth = 1 << 22;
  memory.setAllocBlockSize(kGrowth);
  mrpt::serialization::archiveFrom(memory) << object;
  return gzip(memory.getRawBufferData(), memory.getTotalBytesCount());
}

}  // namespace submap_slam
