#include <fmt/format.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/simulation/simulate.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::poses::CPose2D;
using mrpt::serialization::CArchive;

void writeObservations(CArchive& archive, const Frame& frame) {
  if (frame.odometry) {
    mrpt::obs::CObservationOdometry odometry;
    odometry.timestamp = frame.stamp;
    odometry.sensorLabel = "ODOMETRY";
    odometry.odometry = CPose2D(*frame.odometry);
    archive << odometry;
  }
  for (const auto& scan : frame.scans) archive << *scan;
}

void writeActionAndSensoryFrame(CArchive& archive, const Frame& frame, const TPose2D& increment) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = frame.stamp;
  movement.computeFromOdometry(CPose2D(increment), {});
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  mrpt::obs::CSensoryFrame scans;
  for (const auto& scan : frame.scans) scans.insert(scan);
  archive << actions << scans;
}

/** Odometry increment since the frame before; zero for the first one. */
TPose2D incrementTo(std::size_t k, const std::vector<Frame>& frames) {
  if (k == 0 || !frames[k].odometry || !frames[k - 1].odometry) return {0, 0, 0};
  return *frames[k].odometry - *frames[k - 1].odometry;
}

/** In memory, because MRPT's gzip file stream does not tell when a disk is full, and its compression in
 * memory goes through a temporary file whose name processes that run side by side may share. */
std::string gzip(const void* data, std::size_t size) {
  if (size > std::numeric_limits<uInt>::max())
    throw OutputError("a rawlog of more than 4 GB cannot be packed");
  constexpr int kGzipWindowBits = 15 + 16, kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzipWindowBits, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw OutputError("the compression of a rawlog cannot start");
  std::string packed(deflateBound(&stream, size), '\0');
  stream.next_in = static_cast<Bytef*>(const_cast<void*>(data));
  stream.avail_in = static_cast<uInt>(size);
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int result = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (result != Z_STREAM_END) throw OutputError("a rawlog cannot be compressed");
  return packed;
}

void writeFile(const std::string& file, const char* bytes, std::size_t size) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) throw OutputError(file + ": cannot be opened for writing");
  out.write(bytes, static_cast<std::streamsize>(size));
  out.close();
  if (!out) throw OutputError(file + ": cannot be written");
}

}  // namespace

void writeRawlog(const std::string& file, const SimulatedLog& log, RawlogForm form) {
  constexpr uint64_t kGrowth = 1 << 20;  // bytes; MRPT's default of 4 kB copies too often
  mrpt::io::CMemoryStream stream;
  stream.setAllocBlockSize(kGrowth);
  auto archive = mrpt::serialization::archiveFrom(stream);
  for (std::size_t k = 0; k < log.frames.size(); ++k) {
    if (form == RawlogForm::kObservations)
      writeObservations(archive, log.frames[k]);
    else
      writeActionAndSensoryFrame(archive, log.frames[k], incrementTo(k, log.frames));
  }
  const std::string packed = gzip(stream.getRawBufferData(), stream.getTotalBytesCount());
  writeFile(file, packed.data(), packed.size());
}

void writeTruth(const std::string& file, const Trajectory& truth) {
  std::string text;
  for (const auto& [stamp, pose] : truth)
    text += fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", mrpt::Clock::toDouble(stamp), pose.x,
                        pose.y, std::sin(pose.phi / 2), std::cos(pose.phi / 2));
  writeFile(file, text.data(), text.size());
}

}  // namespace submap_slam
