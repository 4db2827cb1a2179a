#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace submap_slam {

/** A temporary file that is appended to and read. It has no name once it is open, so nobody else can touch
 * it, and it is gone with the program however that ends. Any number of threads may read what was appended.
 * All errors are OutputError. */
class SpillFile {
 public:
  /** @param name where it is made; what makes it unique is added */
  explicit SpillFile(const std::string& name);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /** Returns where the bytes begin. What could not be written whole is written over by the next append. */
  uint64_t append(const void* data, std::size_t count);

  void read(uint64_t start, void* data, std::size_t count) const;

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string name_;
  int file_ = -1;
  uint64_t bytes_ = 0;
};

}  // namespace submap_slam
