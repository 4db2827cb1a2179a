#include "bag_records.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <cstring>

#include "words.h"

namespace submap_slam {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr uint32_t kMostBytes = 1U << 30;  // of a chunk; a greater length is damage
enum Op : uint8_t { kMessage = 2, kChunk = 5, kConnection = 7 };

std::map<std::string, std::string_view> parseHeader(std::string_view text) {
  std::map<std::string, std::string_view> fields;
  BagBytes bytes(text);
  while (!bytes.atEnd()) {
    const std::string_view field = bytes.string();
    const std::size_t equal = field.find('=');
    if (equal == std::string_view::npos) throw LineError("a field of a header has no '='");
    fields[std::string(field.substr(0, equal))] = field.substr(equal + 1);
  }
  return fields;
}

std::string_view fieldOf(const std::map<std::string, std::string_view>& header, const char* name) {
  const auto found = header.find(name);
  if (found == header.end()) throw LineError(fmt::format("a record has no field {}", name));
  return found->second;
}

uint8_t opOf(const std::map<std::string, std::string_view>& header) {
  const std::string_view op = fieldOf(header, "op");
  return op.size() == 1 ? static_cast<uint8_t>(op[0]) : 0;
}

}  // namespace

std::string_view BagBytes::take(std::size_t count) {
  if (count > rest_.size()) throw LineError("a record ends too early");
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

template <class T>
T BagBytes::value() {
  T value;
  std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));  // as all machines that MRPT runs on store it
  return value;
}

uint32_t BagBytes::u32() { return value<uint32_t>(); }
float BagBytes::f32() { return value<float>(); }
double BagBytes::f64() { return value<double>(); }
std::string_view BagBytes::string() { return take(u32()); }

BagReader::BagReader(const std::string& file) : file_(file), source_(file) {
  std::string magic(kMagic.size(), '\0');
  magic.resize(source_.read(magic.data(), magic.size()));
  if (magic != kMagic) throw InputError(fmt::format("{}: is no ROS bag of format 2.0", file));
}

double BagReader::fractionRead() const {
  return static_cast<double>(source_.filePosition()) / static_cast<double>(source_.fileSize());
}

/** Length and bytes. */
std::string BagReader::readBlock() {
  uint32_t size = 0;
  if (source_.read(&size, sizeof(size)) < sizeof(size) || size > kMostBytes)
    throw LineError("a record ends too early, or its length makes no sense");
  std::string block(size, '\0');
  if (source_.read(block.data(), size) < size) throw LineError("the file ends inside of a record");
  return block;
}

/** Takes the next chunk; false at the end. Other records of the file are an index, which is not needed. */
bool BagReader::readChunk() {
  while (!source_.atEnd()) {
    header_ = readBlock();
    data_ = readBlock();
    const auto header = parseHeader(header_);
    if (opOf(header) != kChunk) continue;
    const std::string_view compression = fieldOf(header, "compression");
    if (compression != "none")
      throw InputError(fmt::format("{}: is compressed ({}); unpack it first: rosbag decompress", file_,
                                   compression.substr(0, 10)));
    chunk_ = BagBytes(data_);
    return true;
  }
  return false;
}

BagReader::Record BagReader::parseRecord(BagBytes& bytes) {
  Record record;
  record.header = parseHeader(bytes.string());
  record.data = bytes.string();
  return record;
}

void BagReader::addConnection(const Record& record) {
  BagMessage connection;
  connection.topic = std::string(fieldOf(record.header, "topic"));
  connection.type = std::string(fieldOf(parseHeader(record.data), "type"));
  connections_[BagBytes(fieldOf(record.header, "conn")).u32()] = connection;
}

std::optional<BagMessage> BagReader::next() {
  while (!chunk_.atEnd() || readChunk()) {
    if (chunk_.atEnd()) continue;
    const Record record = parseRecord(chunk_);
    const uint8_t op = opOf(record.header);
    if (op == kConnection) addConnection(record);
    if (op != kMessage) continue;
    const auto connection = connections_.find(BagBytes(fieldOf(record.header, "conn")).u32());
    if (connection == connections_.end()) throw LineError("a message of a connection that was not announced");
    BagMessage message = connection->second;
    message.bytes = record.data;
    return message;
  }
  return std::nullopt;
}

}  // namespace submap_slam
