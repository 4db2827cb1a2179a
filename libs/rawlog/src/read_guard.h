#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace submap_slam {

struct GuardedClass;

/** Refuses corrupt data that MRPT's deserialization does not survive.
 *
 * MRPT resizes first and reads then: one wrong bit in the number of beams or actions asks for gigabytes. And
 * it uses inner objects of the wrong class, or null ones, as if they were right. This follows its reads of
 * one object, knows where the classes of 2D logs have their counts (32-bit numbers among the reads that
 * belong to no inner object) and which classes they hold, and throws std::runtime_error before anything bad
 * happens. Other classes and objects of MRPT < 0.5.5 pass unchecked.
 */
class ReadGuard {
 public:
  /** Call after every read of the archive, with what was read. */
  void onRead(const void* data, std::size_t size);

 private:
  /** An object being read. */
  struct Level {
    const GuardedClass* known = nullptr;  ///< null: nothing is known about its class, or about the rest of it
    std::size_t words = 0;                ///< 32-bit reads so far
    uint32_t first_word = 0;
    bool version_read = false;
    bool flag_read = false;
    std::size_t floats_ahead = 0;  ///< 32-bit reads that no position counts
    std::size_t label = 0;         ///< which read is the number of letters of the label, once that is known
  };

  static void takeFlag(Level& level, bool value);
  bool opensObject(const std::string& class_name);
  void checkInner(const Level& outer, const std::string& class_name) const;
  void checkWord(Level& level, uint32_t value) const;

  std::vector<Level> levels_;
  uint8_t last_byte_ =
      0;  ///< value of the read before, if it was a single byte that may begin or end an object
};

}  // namespace submap_slam
