#include "spill_file.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace submap_slam {

SpillFile::SpillFile(const std::string& name) : name_(name) {
  std::string path = name + ".XXXXXX";
  file_ = mkstemp(path.data());
  if (file_ < 0) fail("made");
  unlink(path.c_str());
}

SpillFile::~SpillFile() { close(file_); }

void SpillFile::fail(const char* what) const {
  throw OutputError(fmt::format("{}: cannot be {}: {}", name_, what, std::strerror(errno)));
}

uint64_t SpillFile::append(const void* data, std::size_t count) {
  const auto* bytes = static_cast<const char*>(data);
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = pwrite(file_, bytes + done, count - done, static_cast<off_t>(bytes_ + done));
    if (n < 0 && errno != EINTR) fail("written");
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  const uint64_t start = bytes_;
  bytes_ += count;
  return start;
}

void SpillFile::read(uint64_t start, void* data, std::size_t count) const {
  auto* bytes = static_cast<char*>(data);
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = pread(file_, bytes + done, count - done, static_cast<off_t>(start + done));
    if (n == 0) errno = EIO;
    if (n <= 0 && errno != EINTR) fail("read again");
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

}  // namespace submap_slam
