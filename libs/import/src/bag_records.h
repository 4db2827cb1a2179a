#pragma once

#include <submap_slam/rawlog/byte_source.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace submap_slam {

/** Takes values from the bytes of a ROS message or record, least byte first. Throws LineError where the bytes
 * end too early. */
class BagBytes {
 public:
  explicit BagBytes(std::string_view bytes) : rest_(bytes) {}

  uint32_t u32();
  float f32();
  double f64();
  std::string_view string();  ///< length and characters
  std::string_view take(std::size_t count);
  bool atEnd() const { return rest_.empty(); }
  std::size_t left() const { return rest_.size(); }

 private:
  template <class T>
  T value();

  std::string_view rest_;
};

/** A message of a bag; what it points to lives until the next one is read. */
struct BagMessage {
  std::string topic, type;  ///< type as "sensor_msgs/LaserScan"
  std::string_view bytes;
};

/** The messages of a ROS 1 bag (format 2.0, chunks without compression) in the order of the file. */
class BagReader {
 public:
  /** Throws InputError if the file cannot be opened or is no bag of that format. */
  explicit BagReader(const std::string& file);

  /** The next message, or nothing at the end. Throws LineError at damage, after which there is nothing more,
   * and InputError for a compressed chunk. */
  std::optional<BagMessage> next();

  double fractionRead() const;

 private:
  struct Record {
    std::map<std::string, std::string_view> header;
    std::string_view data;
  };
  static Record parseRecord(BagBytes& bytes);
  bool readChunk();
  std::string readBlock();
  void addConnection(const Record& record);

  std::string file_;
  ByteSource source_;
  std::string header_, data_;  ///< of the chunk
  BagBytes chunk_{""};
  std::map<uint32_t, BagMessage> connections_;  ///< by number; without bytes
};

}  // namespace submap_slam
