#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace submap_slam {

/** An open file of the system, closed at the end. */
class FileDescriptor {
 public:
  explicit FileDescriptor(int number) : number_(number) {}
  ~FileDescriptor();
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  /** Negative if it could not be opened. */
  int number() const { return number_; }

 private:
  int number_;
};

/** A file that is appended to and is on the disk when sync() returns. All errors are OutputError naming the
 * file. */
class DurableFile {
 public:
  /** Opens or creates the file and locks it, without changing what is in it. While this lives, a second
   * DurableFile of the same file is refused, in this process and in others. */
  explicit DurableFile(const std::string& file);

  /** Drops what is behind the first `bytes`; the next append goes there. */
  void cutTo(uint64_t bytes);

  void append(const void* data, std::size_t count);
  void sync();

 private:
  void lock() const;
  [[noreturn]] void fail(const char* what) const;

  std::string file_;
  FileDescriptor descriptor_;
};

/** Makes the creation or renaming of a file survive a power failure, where the file system can. */
void syncFolderOf(const std::string& file);

}  // namespace submap_slam
