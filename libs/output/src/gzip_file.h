#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace submap_slam {

/** Writes an object as an MRPT archive, compressed piece by piece: neither the archive nor what it is
 * compressed to is ever in memory as a whole. Throws as BinaryFile. */
void writeGzippedArchive(const std::string& file, const mrpt::serialization::CSerializable& object);

}  // namespace submap_slam
