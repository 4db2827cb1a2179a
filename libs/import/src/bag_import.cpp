#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bag_records.h"
#include "forms.h"
#include "laser_scan.h"
#include "rawlog_output.h"
#include "words.h"

namespace submap_slam {
namespace {

using mrpt::math::TPose2D;

constexpr const char *kScanType = "sensor_msgs/LaserScan", *kOdometryType = "nav_msgs/Odometry";

/** std_msgs/Header: sequence number, stamp, frame. Returns the stamp in seconds. */
double readHeader(BagBytes& bytes) {
  bytes.u32();
  const uint32_t seconds = bytes.u32(), nanoseconds = bytes.u32();
  bytes.string();
  return seconds + 1e-9 * nanoseconds;
}

class BagImport {
 public:
  explicit BagImport(const ImportJob& job) : job_(job), bag_(job.file), out_(job.output) {}

  void run() {
    constexpr std::size_t kMessagesBetweenProgress = 256;
    std::size_t count = 0;
    try {
      while (const auto message = bag_.next()) {
        if (++count % kMessagesBetweenProgress == 0 && !job_.progress(bag_.fractionRead(), "reading"))
          throw Interrupted();
        use(*message);
      }
    } catch (const LineError& error) {
      job_.report.damage.push_back(
          fmt::format("{}: {}; what follows the {} messages is lost", job_.file, error.what(), count));
    }
    out_.close();
    summarise();
  }

 private:
  void use(const BagMessage& message) {
    if (message.type == kScanType && isWanted(message.topic)) return writeScan(message);
    if (message.type == kOdometryType && isWanted(message.topic)) {
      if (odometry_topic_.empty()) odometry_topic_ = message.topic;
      if (message.topic == odometry_topic_) return writeOdometry(message);
    }
    left_out_.insert(fmt::format("{} ({})", message.topic, message.type));
  }

  bool isWanted(const std::string& topic) const {
    const auto& topics = job_.options.topics;
    return topics.empty() || std::find(topics.begin(), topics.end(), topic) != topics.end();
  }

  void writeScan(const BagMessage& message) {
    BagBytes bytes(message.bytes);
    const double stamp_s = readHeader(bytes);
    Scanner scanner;
    scanner.label = message.topic;
    scanner.T_robot_sensor = job_.options.T_robot_sensor.value_or(TPose2D());
    scanner.angles.first = bytes.f32();
    bytes.f32();  // angle_max: the step says it better
    scanner.angles.step = bytes.f32();
    for (const char* unused : {"time_increment", "scan_time", "range_min"})
      static_cast<void>(unused), bytes.f32();
    const double range_max = bytes.f32();
    scanner.max_range = job_.options.max_range.value_or(range_max);
    const uint32_t beams = bytes.u32();
    if (beams > bytes.left() / sizeof(float)) throw LineError("a scan ends too early");
    std::vector<double> ranges(beams);
    for (double& range : ranges) range = bytes.f32();
    if (ranges.empty()) return;
    out_.write(makeScan(scanner, stamp_s, ranges));
    ++job_.report.written["scans of " + scanner.label];
  }

  /** Position x y z, orientation x y z w; what is behind is not needed. */
  void writeOdometry(const BagMessage& message) {
    BagBytes bytes(message.bytes);
    const double stamp_s = readHeader(bytes);
    bytes.string();  // child_frame_id
    TPose2D pose;
    pose.x = bytes.f64();
    pose.y = bytes.f64();
    bytes.f64();
    const double qx = bytes.f64(), qy = bytes.f64(), qz = bytes.f64(), qw = bytes.f64();
    pose.phi = std::atan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy * qy + qz * qz));
    out_.write(makeOdometry(stamp_s, pose));
    ++job_.report.written["odometry readings"];
  }

  void summarise() const {
    ImportReport& report = job_.report;
    if (!odometry_topic_.empty()) report.notes.push_back("odometry: " + odometry_topic_);
    if (!left_out_.empty()) report.notes.push_back(fmt::format("left out: {}", fmt::join(left_out_, ", ")));
    if (!job_.options.T_robot_sensor)
      report.warnings.push_back(
          "the pose of the scanner on the robot is not read from the bag; it is taken to be at the robot's "
          "origin. If it is not: --sensor-pose");
  }

  ImportJob job_;
  BagReader bag_;
  RawlogOutput out_;
  std::string odometry_topic_;
  std::set<std::string> left_out_;
};

}  // namespace

void importBag(const ImportJob& job) { BagImport(job).run(); }

}  // namespace submap_slam
