#include "read_guard.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/rtti/CObject.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

namespace submap_slam {

/** What is known about the serialized form of a class. */
struct GuardedClass {
  enum class Inner { kAny, kAction, kObservation, kMovement };

  std::vector<std::size_t>
      counts;  ///< which of its 32-bit reads are counts, from 0; the others are floats and flags
  Inner inner = Inner::kAny;   ///< class of its inner objects
  bool block_follows = false;  ///< behind the first count come its elements in one read

  // a single byte that is a flag, and elements of 32-bit reads, with a label behind them
  std::size_t floats_if_false = 0;    ///< so many more floats behind the flag, which `counts` leaves out
  std::size_t reads_per_element = 0;  ///< of the first count; 0: no such elements
};

namespace {

constexpr uint32_t kLargestCount = 1'000'000;
constexpr uint8_t kHeaderBit = 0x80;  // set in the length of a class name
constexpr uint8_t kEndFlag = 0x88;    // behind each object; also the length of a name of 8 letters

const GuardedClass* find(const std::string& class_name) {
  using Inner = GuardedClass::Inner;
  static const std::map<std::string, GuardedClass> table = {
      {"CActionCollection", {{0}, Inner::kAction, false}},         // actions
      {"CActionRobotMovement2D", {{8}, Inner::kMovement, false}},  // particles of the motion model
      {"CMatrix", {{0, 1}, Inner::kAny, false}},                   // rows, columns
      {"CMatrixF", {{0, 1}, Inner::kAny, false}},
      {"CMatrixD", {{0, 1}, Inner::kAny, false}},
      {"CObservation2DRangeScan", {{2, 5}, Inner::kAny, true}},       // beams, letters of the label
      {"CObservationBearingRange", {{4}, Inner::kAny, false, 3, 4}},  // landmarks
      {"CObservationOdometry", {{0}, Inner::kAny, false}},            // letters of the label
      {"CSensoryFrame", {{0}, Inner::kObservation, false}},           // observations
  };
  const auto found = table.find(class_name.substr(class_name.rfind(':') + 1));
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace

void ReadGuard::onRead(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const char*>(data);
  const uint8_t before = std::exchange(last_byte_, uint8_t{0});
  if (before != 0 && size == (before & ~kHeaderBit) && opensObject({bytes, size})) return;
  if (before == kEndFlag && !levels_.empty()) levels_.pop_back();
  if (!levels_.empty() && !levels_.back().version_read) {
    levels_.back().version_read = true;
    return;
  }
  const auto first = static_cast<uint8_t>(bytes[0]);
  if (size == 1 && first >= kHeaderBit) last_byte_ = first;
  if (size == 1 && first < kHeaderBit && !levels_.empty()) takeFlag(levels_.back(), first != 0);
  if (size != sizeof(uint32_t) || levels_.empty()) return;
  uint32_t word = 0;
  std::memcpy(&word, data, sizeof(word));
  checkWord(levels_.back(), word);
}

void ReadGuard::takeFlag(Level& level, bool value) {
  if (!level.known || level.flag_read) return;
  level.flag_read = true;
  if (!value) level.floats_ahead = level.known->floats_if_false;
}

bool ReadGuard::opensObject(const std::string& class_name) {
  const bool null = class_name == "nullptr";  // has no version
  if (!null && !mrpt::rtti::findRegisteredClass(class_name)) return false;
  if (!levels_.empty()) checkInner(levels_.back(), class_name);
  Level level;
  level.known = find(class_name);
  level.version_read = null;
  levels_.push_back(level);
  return true;
}

void ReadGuard::checkInner(const Level& outer, const std::string& class_name) const {
  if (!outer.known || outer.known->inner == GuardedClass::Inner::kAny) return;
  const auto* id = mrpt::rtti::findRegisteredClass(class_name);
  const auto is = [id](const mrpt::rtti::TRuntimeClassId* base) { return id && id->derivedFrom(base); };
  bool right = false;
  switch (outer.known->inner) {
    case GuardedClass::Inner::kAction:
      right = is(CLASS_ID(mrpt::obs::CAction));
      break;
    case GuardedClass::Inner::kObservation:
      right = is(CLASS_ID(mrpt::obs::CObservation));
      break;
    case GuardedClass::Inner::kMovement: {
      // odometry (method 0, the first word) is a plain increment, every other estimate a distribution
      const bool plain = outer.words > 0 && outer.first_word == mrpt::obs::CActionRobotMovement2D::emOdometry;
      right = is(plain ? CLASS_ID(mrpt::poses::CPose2D) : CLASS_ID(mrpt::poses::CPosePDF));
      break;
    }
    case GuardedClass::Inner::kAny:
      right = true;
      break;
  }
  if (!right) throw std::runtime_error("inner object of a wrong class");
}

void ReadGuard::checkWord(Level& level, uint32_t value) const {
  if (level.floats_ahead > 0) {
    --level.floats_ahead;
    return;
  }
  const std::size_t index = level.words++;
  if (index == 0) level.first_word = value;
  if (!level.known) return;
  const auto& counts = level.known->counts;
  const bool label = level.label > 0 && index == level.label;
  if (!label && std::find(counts.begin(), counts.end(), index) == counts.end()) return;
  if (value > kLargestCount) throw std::runtime_error("implausible count");
  if (!label && level.known->reads_per_element > 0)
    level.label = index + 1 + level.known->reads_per_element * value;
  // one range or four validity flags are a 32-bit read too: the positions behind are unknown
  const bool confusing = value == 1 || value == sizeof(uint32_t);
  if (level.known->block_follows && confusing) level.known = nullptr;
}

}  // namespace submap_slam
