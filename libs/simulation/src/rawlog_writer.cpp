#include <fmt/format.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/gzip.h>
#include <submap_slam/simulation/simulate.h>

#include <cmath>
#include <fstream>

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::obs::CObservationBearingRange;
using mrpt::poses::CPose2D;
using mrpt::serialization::CArchive;

mrpt::obs::CObservationOdometry odometryAt(mrpt::Clock::time_point stamp, const TPose2D& pose) {
  mrpt::obs::CObservationOdometry odometry;
  odometry.timestamp = stamp;
  odometry.sensorLabel = "ODOMETRY";
  odometry.odometry = CPose2D(pose);
  return odometry;
}

mrpt::obs::CObservationOdometry odometryWithVelocity(const VelocityReading& reading) {
  auto odometry = odometryAt(reading.stamp, reading.pose);
  odometry.hasVelocities = true;
  odometry.velocityLocal = reading.velocity;
  return odometry;
}

CObservationBearingRange toObservation(const LandmarkScan& scan, mrpt::Clock::time_point stamp) {
  CObservationBearingRange observation;
  observation.timestamp = stamp;
  observation.sensorLabel = scan.sensor_label;
  observation.setSensorPose(mrpt::poses::CPose3D(mrpt::math::TPose3D(scan.T_robot_sensor)));
  observation.maxSensorDistance = static_cast<float>(scan.max_range);
  observation.fieldOfView_yaw = static_cast<float>(scan.field_of_view);
  observation.fieldOfView_pitch = 0;
  observation.sensor_std_range = static_cast<float>(scan.sigma_range);
  observation.sensor_std_yaw = static_cast<float>(scan.sigma_bearing);
  for (const LandmarkMeasurement& measurement : scan.measurements) {
    auto& sensed = observation.sensedData.emplace_back();
    sensed.range = static_cast<float>(measurement.range);
    sensed.yaw = static_cast<float>(measurement.bearing);
    sensed.pitch = 0;
    sensed.landmarkID = measurement.id ? static_cast<int32_t>(*measurement.id) : -1;
  }
  return observation;
}

/** All that sensors saw, apart from odometry. */
std::vector<mrpt::obs::CObservation::Ptr> observationsOf(const Frame& frame) {
  std::vector<mrpt::obs::CObservation::Ptr> observations(frame.scans.begin(), frame.scans.end());
  for (const LandmarkScan& scan : frame.landmark_scans)
    observations.push_back(CObservationBearingRange::Create(toObservation(scan, frame.stamp)));
  return observations;
}

void writeObservations(CArchive& archive, const SimulatedLog& log) {
  auto reading = log.velocities.begin();
  for (const Frame& frame : log.frames) {
    for (; reading != log.velocities.end() && reading->stamp <= frame.stamp; ++reading)
      archive << odometryWithVelocity(*reading);
    if (log.velocities.empty() && frame.odometry) archive << odometryAt(frame.stamp, *frame.odometry);
    for (const auto& observation : observationsOf(frame)) archive << *observation;
  }
}

void writeActionAndSensoryFrame(CArchive& archive, const Frame& frame, const TPose2D& increment) {
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = frame.stamp;
  movement.computeFromOdometry(CPose2D(increment), {});
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  mrpt::obs::CSensoryFrame sensory_frame;
  for (const auto& observation : observationsOf(frame)) sensory_frame.insert(observation);
  archive << actions << sensory_frame;
}

/** Odometry increment since the frame before; zero for the first one. */
TPose2D incrementTo(std::size_t k, const std::vector<Frame>& frames) {
  if (k == 0 || !frames[k].odometry || !frames[k - 1].odometry) return {0, 0, 0};
  return *frames[k].odometry - *frames[k - 1].odometry;
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
  if (form == RawlogForm::kObservations) {
    writeObservations(archive, log);
  } else {
    for (std::size_t k = 0; k < log.frames.size(); ++k)
      writeActionAndSensoryFrame(archive, log.frames[k], incrementTo(k, log.frames));
  }
  // In memory, because MRPT's gzip file stream does not tell when a disk is full.
  const std::string packed =
      gzip(stream.getRawBufferData(), stream.getTotalBytesCount(), GzipLevel::kSmallest);
  writeFile(file, packed.data(), packed.size());
}

void writeTrueLandmarks(const std::string& file, const std::vector<TrueLandmark>& landmarks) {
  std::string text = "id,x,y\n";
  for (const auto& [id, position] : landmarks)
    text += fmt::format("{},{:.6f},{:.6f}\n", id, position.x, position.y);
  writeFile(file, text.data(), text.size());
}

void writeTruth(const std::string& file, const Trajectory& truth) {
  std::string text;
  for (const auto& [stamp, pose] : truth)
    text += fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", mrpt::Clock::toDouble(stamp), pose.x,
                        pose.y, std::sin(pose.phi / 2), std::cos(pose.phi / 2));
  writeFile(file, text.data(), text.size());
}

}  // namespace submap_slam
