#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace submap_slam {

/** A file that is appended to and is on the disk when sync() returns. All errors are OutputError naming the
 * file. */
class DurableFile {
 public:
  /** Opens or creates the file and drops what is behind the first `keep_bytes`. */
  DurableFile(const std::string& file, uint64_t keep_bytes);
  ~DurableFile();
  DurableFile(DurableFile&& other) noexcept;
  DurableFile& operator=(DurableFile&& other) noexcept;

  void append(const void* data, std::size_t count);
  void sync();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string file_;
  int descriptor_ = -1;
};

/** Makes the creation or renaming of a file survive a power failure, where the file system can. */
void syncFolderOf(const std::string& file);

}  // namespace submap_slam
