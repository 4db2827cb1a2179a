#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <string>

namespace submap_slam {

/** How much work compression is worth. */
enum class GzipLevel { kFastest = 1, kUsual = 6, kSmallest = 12 };

/** Compresses in one step into a gzip member without name and time, so that the same data give the same
 * bytes. Throws std::bad_alloc. */
std::string gzip(const void* data, std::size_t size, GzipLevel level);

/** The object as an MRPT archive, compressed. */
std::string gzippedArchive(const mrpt::serialization::CSerializable& object, GzipLevel level);

}  // namespace submap_slam
