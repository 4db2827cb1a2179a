#pragma once

#include <cstddef>
#include <fstream>
#include <string>

namespace submap_slam {

/** A file that is written from its beginning. All its functions throw OutputError naming the file as soon as
 * something of it is known not to reach the file system. */
class BinaryFile {
 public:
  explicit BinaryFile(const std::string& file);
  void write(const char* bytes, std::size_t size);
  void close();

  /** Throws again what an earlier call threw, if one did. */
  void check();

 private:
  std::string file_;
  std::ofstream out_;
  int error_ = 0;  // errno of the first failure, if it is known
};

/** Writes the whole file; throws as BinaryFile. */
void writeBytes(const std::string& file, const std::string& bytes);

}  // namespace submap_slam
