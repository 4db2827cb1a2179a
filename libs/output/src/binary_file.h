#pragma once

#include <cstddef>
#include <fstream>
#include <string>

namespace submap_slam {

/** A file that is written from its beginning, and of which no failure is missed. */
class BinaryFile {
 public:
  explicit BinaryFile(const std::string& file);
  void write(const char* bytes, std::size_t size);

  /** Throws OutputError naming the file if anything of it did not reach the file system. */
  void close();

 private:
  void noteFailure();

  std::string file_;
  std::ofstream out_;
  int error_ = 0;  // errno of the first failure, if it is known
};

/** Writes the whole file; throws as BinaryFile::close. */
void writeBytes(const std::string& file, const std::string& bytes);

}  // namespace submap_slam
