#include <libdeflate.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/gzip.h>

#include <memory>
#include <new>

namespace submap_slam {

std::string gzip(const void* data, std::size_t size, GzipLevel level) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(static_cast<int>(level)), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string packed(libdeflate_gzip_compress_bound(compressor.get(), size), '\0');
  packed.resize(libdeflate_gzip_compress(compressor.get(), data, size, packed.data(), packed.size()));
  return packed;
}

std::string gzippedArchive(const mrpt::serialization::CSerializable& object, GzipLevel level) {
  mrpt::io::CMemoryStream memory;
  constexpr uint64_t kGrowth = 1 << 22;  // its default, 4 kB, moves a large object a thousand times
  memory.setAllocBlockSize(kGrowth);
  mrpt::serialization::archiveFrom(memory) << object;
  return gzip(memory.getRawBufferData(), memory.getTotalBytesCount(), level);
}

}  // namespace submap_slam
