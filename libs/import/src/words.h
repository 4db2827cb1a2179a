#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace submap_slam {

/** What is wrong with a line; whoever reads lines adds file and number. */
struct LineError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** The words of a line, separated by blanks, taken one after the other. */
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  /** The next word; empty at the end of the line. */
  std::string_view next();

  /** Number of words that are left. */
  std::size_t left() const;

  // Each takes the next word and throws LineError, naming `what`, if it is something else.
  double anyNumber(const char* what);  ///< NaN and infinity included
  double number(const char* what);     ///< a finite one
  uint32_t wholeNumber(const char* what);

  void requireEnd();

 private:
  std::string_view rest_;
};

/** True if the text is a number as a whole, NaN and infinity included. */
bool isNumber(std::string_view text);

}  // namespace submap_slam
