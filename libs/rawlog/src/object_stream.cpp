#include "object_stream.h"

#include <fmt/format.h>
#include <mrpt/rtti/CObject.h>

#include <algorithm>
#include <cctype>

#include "read_guard.h"

namespace submap_slam {
namespace {

constexpr std::size_t kLongestClassName = 120;  // MRPT's own limit

/** Feeds MRPT's deserialization; unlike its own archives it never gives fewer bytes than asked for. */
class SourceArchive : public mrpt::serialization::CArchive {
 public:
  explicit SourceArchive(ByteSource& source) : source_(source) {}
  bool ranOut() const { return ran_out_; }

 protected:
  std::size_t read(void* to, std::size_t count) override {
    if (source_.read(to, count) == count) {
      guard_.onRead(to, count);
      return count;
    }
    ran_out_ = true;
    throw std::runtime_error("end of data");
  }
  std::size_t write(const void*, std::size_t) override { throw std::logic_error("archive is read-only"); }

 private:
  ByteSource& source_;
  ReadGuard guard_;
  bool ran_out_ = false;
};

/** Letters, digits and what templates and namespaces need. */
bool isClassName(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("_:<>, ").find(c) != std::string_view::npos;
  });
}

struct ObjectHeader {
  bool plausible = false;  ///< can be (the beginning of) an object header
  bool complete = false;
  std::string class_name;
};

/** A header is the length of the class name (since MRPT 0.5.5 with the top bit set, before as 32-bit number)
 * and the name. */
ObjectHeader parseHeader(const std::string& bytes) {
  const auto first = static_cast<uint8_t>(bytes[0]);
  const bool old_format = first < 0x80;
  const std::size_t begin = old_format ? 4 : 1, length = first & 0x7f;
  ObjectHeader header;
  header.class_name = bytes.substr(std::min(begin, bytes.size()), length);
  header.complete = bytes.size() >= begin + length;
  const std::string length_rest = old_format ? bytes.substr(1, 3) : "";
  header.plausible = length > 0 && length <= kLongestClassName && isClassName(header.class_name) &&
                     std::all_of(length_rest.begin(), length_rest.end(), [](char c) { return c == 0; });
  return header;
}

/** The class that an exception of MRPT says is not registered, or "" (also for a name of rubbish). */
std::string unregisteredClassIn(const std::string& message) {
  const std::string before = "has class '";
  const auto begin = message.find(before);
  if (begin == std::string::npos) return "";
  const auto name = begin + before.size();
  const auto class_name = message.substr(name, message.find('\'', name) - name);
  return isClassName(class_name) ? class_name : "";
}

/** Whether MRPT refused an object because it knows only older versions of its class. */
bool isNewerVersion(const std::string& message) {
  return message.find("unknown serialization version") != std::string::npos;
}

/** " because …" where MRPT says that an observation holds a landmark twice, which it does not read. */
std::string repeatedLandmark(const std::string& message) {
  const std::string before = "Duplicate landmark ID=";
  const auto at = message.find(before);
  if (at == std::string::npos) return "";
  const auto id = message.substr(at + before.size());
  return fmt::format(" because it has the landmark id {} twice", id.substr(0, id.find(' ')));
}

std::string unknownClass(const std::string& name) {
  return fmt::format("holds class {}, which this program does not know and cannot skip", name);
}

}  // namespace

ObjectStream::ObjectStream(const std::string& file, uint64_t offset)
    : file_(file), source_(file, offset), valid_bytes_(offset) {}

mrpt::serialization::CSerializable::Ptr ObjectStream::next() {
  while (!damage_) {
    object_start_ = source_.position();
    if (source_.atEnd()) {
      if (!source_.damage().empty()) fail(source_.damage(), source_.truncated());
      break;
    }
    if (auto object = readObject()) return object;
  }
  return nullptr;
}

/** Null for a stored null pointer and at damage. */
mrpt::serialization::CSerializable::Ptr ObjectStream::readObject() {
  const auto header = parseHeader(source_.peek(4 + kLongestClassName));
  if (!header.plausible)
    return fail(entries_ == 0 ? "this is no rawlog" : "expected a serialized MRPT object", false);
  if (!header.complete) return fail("the file ends in the middle of an object", true);
  const bool null = header.class_name == "nullptr";
  if (!null && !mrpt::rtti::findRegisteredClass(header.class_name))
    return fail(unknownClass(header.class_name), false);

  SourceArchive archive(source_);
  try {
    auto object = archive.ReadObject();
    ++entries_;
    at_member_end_ = source_.atMemberEnd();
    if (at_member_end_) valid_bytes_ = source_.filePosition();
    return object;
  } catch (const std::exception& error) {
    if (!source_.damage().empty()) return fail(source_.damage(), source_.truncated());
    if (archive.ranOut())
      return fail(fmt::format("the file ends in the middle of a {}", header.class_name), true);
    if (isNewerVersion(error.what()))
      return fail(
          fmt::format("the content of a {} makes no sense: only newer versions of the program know its "
                      "format, or it is damaged",
                      header.class_name),
          false);
    const auto unknown = unregisteredClassIn(error.what());
    return fail(unknown.empty() ? fmt::format("the content of a {} makes no sense{}", header.class_name,
                                              repeatedLandmark(error.what()))
                                : unknownClass(unknown),
                false);
  }
}

bool ObjectStream::cutBehindLast() { return !at_member_end_ && source_.atEnd(); }

double ObjectStream::fractionRead() const {
  const auto size = source_.fileSize();
  return size == 0 ? 1.0 : static_cast<double>(source_.filePosition()) / static_cast<double>(size);
}

std::nullptr_t ObjectStream::fail(const std::string& reason, bool truncated) {
  LogDamage damage;
  damage.entry = entries_;
  damage.data_byte = object_start_;
  damage.file_byte = source_.filePosition();
  damage.truncated = truncated;
  damage.text = fmt::format("{}: entry {} at byte {}{}: {}", file_, entries_, object_start_,
                            source_.isGzip() ? " of the unpacked data" : "", reason);
  damage_ = damage;
  return nullptr;
}

}  // namespace submap_slam
