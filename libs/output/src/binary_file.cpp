#include "binary_file.h"

#include <submap_slam/core/errors.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace submap_slam {
void writeBytes(const std::string& file, const std::string& bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  if (out) out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  // A full disk may show only now.
  if (out) out.close();
  if (!out)
    throw OutputError(file +
                      ": cannot be written: " + (errno != 0 ? std::strerror(errno) : "unknown reason"));
}

}  // namespace submap_slam
