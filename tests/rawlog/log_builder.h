#pragma once

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

namespace submap_slam {

/** A stamp `seconds` after an arbitrary time in 2020. */
inline mrpt::Clock::time_point at(double seconds) {
  return mrpt::Clock::fromDouble(1.6e9) +
         std::chrono::duration_cast<mrpt::Clock::duration>(std::chrono::duration<double>(seconds));
}

/** A scan of four beams, 1 m to 4 m. */
inline mrpt::obs::CObservation2DRangeScan scanAt(double seconds, const std::string& label = "LASER") {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.timestamp = at(seconds);
  scan.sensorLabel = label;
  scan.aperture = 1.5f;
  scan.maxRange = 20.0f;
  scan.resizeScanAndAssign(4, 1.0f, true);
  for (std::size_t i = 0; i < 4; ++i) scan.setScanRange(i, static_cast<float>(i + 1));
  return scan;
}

inline mrpt::obs::CObservationOdometry odometryAt(double seconds, double x, double y, double phi) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = at(seconds);
  odometry.sensorLabel = "ODOMETRY";
  odometry.odometry = mrpt::poses::CPose2D(x, y, phi);
  return odometry;
}

inline mrpt::obs::CActionCollection movement(double x, double y, double phi) {
  mrpt::obs::CActionRobotMovement2D action;
  action.computeFromOdometry(mrpt::poses::CPose2D(x, y, phi), {});
  return mrpt::obs::CActionCollection(action);
}

/** The serialized objects of a rawlog. */
class LogBuilder {
 public:
  LogBuilder& add(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream) << object;
    bytes_.append(static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount());
    ends_.push_back(bytes_.size());
    return *this;
  }

  /** A sensory frame with these scans. */
  LogBuilder& addFrame(const std::vector<mrpt::obs::CObservation2DRangeScan>& scans) {
    mrpt::obs::CSensoryFrame sensory_frame;
    for (const auto& scan : scans) sensory_frame.insert(mrpt::obs::CObservation2DRangeScan::Create(scan));
    return add(sensory_frame);
  }

  const std::string& bytes() const { return bytes_; }

  /** Offsets behind each object. */
  const std::vector<std::size_t>& ends() const { return ends_; }

  std::string savePlain(const std::string& file) const {
    std::ofstream(file, std::ios::binary) << bytes_;
    return file;
  }

  std::string saveGz(const std::string& file) const {
    mrpt::io::CFileGZOutputStream out(file);
    out.Write(bytes_.data(), bytes_.size());
    return file;
  }

 private:
  std::string bytes_;
  std::vector<std::size_t> ends_;
};

inline std::vector<Frame> allFrames(RawlogReader& reader) {
  std::vector<Frame> frames;
  while (auto frame = reader.next()) frames.push_back(std::move(*frame));
  return frames;
}

inline std::vector<Frame> framesOf(const std::string& file, const ReaderParams& params = {}) {
  RawlogReader reader(file, params);
  return allFrames(reader);
}

}  // namespace submap_slam
