#pragma once

#include <submap_slam/core/landmark_submap.h>

#include <string>
#include <string_view>

namespace submap_slam {

/** Reads submaps from the text form (see readLandmarkSubmaps), one by one. */
class LandmarkText {
 public:
  /** @param name file that messages name
   * @param text must outlive this object */
  LandmarkText(std::string name, std::string_view text) : name_(std::move(name)), text_(text) {}

  /** The next submap, or null behind the last one. Throws InputError. */
  LandmarkSubmap::Ptr next();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  bool readLine();
  void requireLine(const std::string& expected);
  std::string_view word();
  double number();
  uint32_t wholeNumber(const std::string& expected);
  void requireEndOfLine(const std::string& expected);
  double stateElement(const char* what, uint32_t& id);
  void readState(LandmarkSubmap& submap, uint32_t dimension);
  void readCovariance(LandmarkSubmap& submap, uint32_t dimension);

  std::string name_;
  std::string_view text_, line_;  ///< what is left of the text, and of the line
  std::size_t line_number_ = 0;   ///< from 1
  uint32_t submaps_ = 0;
};

/** The submaps in the text form. */
std::string landmarkText(const LandmarkSubmaps& submaps);

}  // namespace submap_slam
