#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace submap_slam {

/** Writes the whole file; throws OutputError naming it if anything of it did not reach the file system. */
void writeBytes(const std::string& file, const std::string& bytes);

/** The object as an MRPT archive, compressed as gzip does, without name and time so that equal objects give
 * equal bytes. */
std::string compressedArchive(const mrpt::serialization::CSerializable& object);

}  // namespace submap_slam
