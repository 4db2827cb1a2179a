#include "binary_file.h"

#include <submap_slam/core/errors.h>

#include <cerrno>
#include <cstring>

namespace submap_slam {

BinaryFile::BinaryFile(const std::string& file) : file_(file) {
  errno = 0;
  out_.open(file, std::ios::binary);
  check();
}

void BinaryFile::write(const char* bytes, std::size_t size) {
  errno = 0;
  out_.write(bytes, static_cast<std::streamsize>(size));
  check();
}

void BinaryFile::close() {
  errno = 0;
  out_.close();  // a full disk may show only now
  check();
}

void BinaryFile::check() {
  if (out_) return;
  if (error_ == 0) error_ = errno;
  throw OutputError(file_ +
                    ": cannot be written: " + (error_ != 0 ? std::strerror(error_) : "unknown reason"));
}

void writeBytes(const std::string& file, const std::string& bytes) {
  BinaryFile out(file);
  out.write(bytes.data(), bytes.size());
  out.close();
}

}  // namespace submap_slam
