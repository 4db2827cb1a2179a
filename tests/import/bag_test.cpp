#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose2D.h>

#include <cmath>

#include "imported.h"

namespace submap_slam {
namespace {

using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using testing::ElementsAre;
using testing::HasSubstr;

// A bag by hand, as the description of format 2.0 says: each record is a header of fields `name=value` and
// data, each with its length in front.

template <class T>
std::string raw(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

std::string withLength(const std::string& bytes) { return raw(static_cast<uint32_t>(bytes.size())) + bytes; }

std::string field(const std::string& name, const std::string& value) {
  return withLength(name + "=" + value);
}

std::string record(const std::string& fields, const std::string& data) {
  return withLength(fields) + withLength(data);
}

std::string connection(uint32_t number, const std::string& topic, const std::string& type) {
  return record(field("op", "\x07") + field("conn", raw(number)) + field("topic", topic),
                field("topic", topic) + field("type", type));
}

std::string message(uint32_t number, const std::string& bytes) {
  return record(field("op", "\x02") + field("conn", raw(number)) + field("time", std::string(8, '\0')),
                bytes);
}

std::string bag(const std::string& chunk, const std::string& compression = "none") {
  const std::string bag_header =
      record(field("op", "\x03") + field("index_pos", std::string(8, '\0')), "   ");
  const std::string index = record(field("op", "\x04"), std::string(12, '\0'));
  return "#ROSBAG V2.0\n" + bag_header +
         record(field("op", "\x05") + field("compression", compression), chunk) + index;
}

std::string header(uint32_t seconds, uint32_t nanoseconds) {
  return raw(uint32_t{0}) + raw(seconds) + raw(nanoseconds) + withLength("laser");
}

std::string scan(uint32_t seconds) {
  std::string bytes = header(seconds, 250000000);
  for (const float f : {-1.0F, 1.0F, 0.5F, 0.0F, 0.1F, 0.05F, 10.0F}) bytes += raw(f);
  bytes += raw(uint32_t{5});
  for (const float f : {1.0F, 2.0F, 10.0F, NAN, 5.0F}) bytes += raw(f);
  return bytes + raw(uint32_t{0});  // intensities
}

std::string odometry(uint32_t seconds, double x, double heading) {
  std::string bytes = header(seconds, 0) + withLength("base_link");
  for (const double d : {x, 2.0, 0.0, 0.0, 0.0, std::sin(heading / 2), std::cos(heading / 2)})
    bytes += raw(d);
  return bytes + std::string(36 * 8 + 6 * 8 + 36 * 8, '\0');
}

const std::string kConnections = connection(0, "/scan", "sensor_msgs/LaserScan") +
                                 connection(1, "/odom", "nav_msgs/Odometry") +
                                 connection(2, "/wheels", "nav_msgs/Odometry");

TEST(Bag, HasScansAndOdometry) {
  const auto log = importText(bag(kConnections + message(1, odometry(100, 1, 0.5)) + message(0, scan(100)) +
                                  message(2, odometry(100, 7, 0)) + message(0, scan(101))));
  const auto scans = log.all<CObservation2DRangeScan>();
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(scans[0]->sensorLabel, "/scan");
  EXPECT_NEAR(seconds(*scans[0]), 100.25, 1e-6);
  EXPECT_NEAR(scans[0]->aperture, 2, 1e-6);
  EXPECT_NEAR(scans[0]->getScanAngle(0), -1, 1e-6);
  EXPECT_FLOAT_EQ(scans[0]->getScanRange(1), 2);
  EXPECT_TRUE(scans[0]->getScanRangeValidity(1));
  EXPECT_FALSE(scans[0]->getScanRangeValidity(2));
  EXPECT_FALSE(scans[0]->getScanRangeValidity(3));
  const auto readings = log.all<CObservationOdometry>();
  ASSERT_EQ(readings.size(), 1u);
  EXPECT_NEAR(readings[0]->odometry.x(), 1, 1e-9);
  EXPECT_NEAR(readings[0]->odometry.phi(), 0.5, 1e-9);
  EXPECT_THAT(log.report.notes, ElementsAre("odometry: /odom", "left out: /wheels (nav_msgs/Odometry)"));
}

TEST(Bag, ReadsABagThatRosWrote) {  // by rosbag 1.15: three scans and odometry readings
  const TempFolder temp;
  const auto report = importFile(IMPORT_TEST_DATA "/ros1.bag", temp.file("a.rawlog"), {}, {});
  EXPECT_FALSE(report.damaged()) << report.asText();
  EXPECT_EQ(report.written.at("scans of /scan"), 3u);
  EXPECT_EQ(report.written.at("odometry readings"), 3u);
  const auto objects = readObservations(temp.file("a.rawlog"));
  ASSERT_EQ(objects.size(), 6u);
  const auto& scan = dynamic_cast<const CObservation2DRangeScan&>(*objects[5]);
  EXPECT_NEAR(seconds(scan), 1700000000.4, 1e-6);
  ASSERT_EQ(scan.getScanSize(), 181u);
  EXPECT_FLOAT_EQ(scan.getScanRange(179), 3.79F);
  EXPECT_FALSE(scan.getScanRangeValidity(180));  // infinite
  EXPECT_NEAR(dynamic_cast<const CObservationOdometry&>(*objects[4]).odometry.phi(), 0.2, 1e-9);
}

TEST(Bag, TopicsAndSensorPoseAreChosen) {
  ImportOptions options;
  options.topics = {"/scan", "/wheels"};
  options.T_robot_sensor = mrpt::math::TPose2D(0.3, 0, 0);
  const auto log = importText(bag(kConnections + message(1, odometry(100, 1, 0.5)) + message(0, scan(100)) +
                                  message(2, odometry(100, 7, 0))),
                              options);
  ASSERT_EQ(log.all<CObservationOdometry>().size(), 1u);
  EXPECT_NEAR(log.all<CObservationOdometry>()[0]->odometry.x(), 7, 1e-9);
  EXPECT_NEAR(log.all<CObservation2DRangeScan>()[0]->sensorPose.x(), 0.3, 1e-6);
  EXPECT_TRUE(log.report.warnings.empty());
}

TEST(Bag, KeepsWhatIsInFrontOfDamage) {
  std::string bytes = bag(kConnections + message(0, scan(100))) + bag(message(0, scan(101))).substr(13);
  bytes.resize(bytes.size() - 60);
  const auto log = importText(bytes);
  EXPECT_EQ(log.all<CObservation2DRangeScan>().size(), 1u);
  EXPECT_THAT(log.report.damage.at(0),
              HasSubstr("the file ends inside of a record; what follows the 1 messages is lost"));
}

TEST(Bag, RefusesWhatItCannotRead) {
  EXPECT_THAT(refusal(bag("xyz", "bz2")),
              HasSubstr("is compressed (bz2); unpack it first: rosbag decompress"));
  EXPECT_THAT(refusal(bag(kConnections)), HasSubstr("holds nothing that can be used"));
  EXPECT_THAT(refusal(bag(message(9, scan(1)))),
              HasSubstr("a message of a connection that was not announced"));
  EXPECT_THAT(refusal("#ROSBAG V2.0\n\xff\xff\xff\xff"), HasSubstr("its length makes no sense"));
}

}  // namespace
}  // namespace submap_slam
