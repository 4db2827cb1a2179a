#include "durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace submap_slam {

FileDescriptor::~FileDescriptor() {
  if (number_ >= 0) ::close(number_);
}

DurableFile::DurableFile(const std::string& file)
    : file_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644)) {
  if (descriptor_.number() < 0) fail("cannot be opened for writing");
  lock();
}

void DurableFile::lock() const {
  if (::flock(descriptor_.number(), LOCK_EX | LOCK_NB) == 0) return;
  // some network file systems cannot lock; that is no error
  if (errno == EWOULDBLOCK) throw OutputError(fmt::format("{}: another run is writing it", file_));
}

void DurableFile::cutTo(uint64_t bytes) {
  const auto length = static_cast<off_t>(bytes);
  struct stat status {};
  const bool cut =
      ::fstat(descriptor_.number(), &status) != 0 || status.st_size != length;  // devices cannot be cut
  if ((cut && ::ftruncate(descriptor_.number(), length) != 0) ||
      ::lseek(descriptor_.number(), length, SEEK_SET) != length)
    fail("cannot be cut to length");
}

void DurableFile::append(const void* data, std::size_t count) {
  const auto* bytes = static_cast<const char*>(data);
  while (count > 0) {
    const ssize_t written = ::write(descriptor_.number(), bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("writing failed");
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

void DurableFile::sync() {
  // devices and some file systems cannot sync; that is no error
  if (::fsync(descriptor_.number()) != 0 && errno != EINVAL && errno != EROFS)
    fail("writing to the disk failed");
}

void DurableFile::fail(const char* what) const {
  throw OutputError(fmt::format("{}: {}: {}", file_, what, std::strerror(errno)));
}

void syncFolderOf(const std::string& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  const FileDescriptor descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor.number() >= 0) ::fsync(descriptor.number());
}

}  // namespace submap_slam
