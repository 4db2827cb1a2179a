#include "rawlog_output.h"

#include <fmt/format.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>

#include <cerrno>
#include <cstring>

namespace submap_slam {

RawlogOutput::RawlogOutput(const std::string& file) : file_(file), out_(gzopen(file.c_str(), "wb")) {
  if (out_ == nullptr) fail();
}

RawlogOutput::~RawlogOutput() {
  if (out_ != nullptr) gzclose(out_);
}

void RawlogOutput::write(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream bytes;
  auto archive = mrpt::serialization::archiveFrom(bytes);
  archive << object;
  const auto size = static_cast<unsigned>(bytes.getTotalBytesCount());
  if (gzwrite(out_, bytes.getRawBufferData(), size) != static_cast<int>(size)) fail();
}

void RawlogOutput::close() {
  const gzFile out = out_;
  out_ = nullptr;
  if (gzclose(out) != Z_OK) fail();
}

void RawlogOutput::fail() const {
  throw OutputError(fmt::format("{}: cannot be written: {}", file_, std::strerror(errno)));
}

}  // namespace submap_slam
