#include "durable_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace submap_slam {

DurableFile::DurableFile(const std::string& file, uint64_t keep_bytes) : file_(file) {
  descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("cannot be opened for writing");
  const auto length = static_cast<off_t>(keep_bytes);
  struct stat status {};
  const bool cut = ::fstat(descriptor_, &status) != 0 || status.st_size != length;  // devices cannot be cut
  if ((cut && ::ftruncate(descriptor_, length) != 0) || ::lseek(descriptor_, length, SEEK_SET) != length) {
    const int error = errno;
    ::close(std::exchange(descriptor_, -1));
    errno = error;
    fail("cannot be cut to length");
  }
}

DurableFile::~DurableFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

DurableFile::DurableFile(DurableFile&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

DurableFile& DurableFile::operator=(DurableFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

void DurableFile::append(const void* data, std::size_t count) {
  const auto* bytes = static_cast<const char*>(data);
  while (count > 0) {
    const ssize_t written = ::write(descriptor_, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("writing failed");
    bytes += written;
    count -= static_cast<std::size_t>(written);
  }
}

void DurableFile::sync() {
  // devices and some file systems cannot sync; that is no error
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) fail("writing to the disk failed");
}

void DurableFile::fail(const char* what) const {
  throw OutputError(fmt::format("{}: {}: {}", file_, what, std::strerror(errno)));
}

void syncFolderOf(const std::string& file) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace submap_slam
