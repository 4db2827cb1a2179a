#pragma once

#include <submap_slam/core/progress.h>
#include <submap_slam/import/import.h>
#include <submap_slam/rawlog/byte_source.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace submap_slam {

/** The lines of a text file, gzip or not, one by one. */
class TextLines {
 public:
  /** Throws InputError if the file cannot be opened. */
  explicit TextLines(const std::string& file);

  /** Takes the next line; false at the end and at damage. A last line without an end counts. Throws
   * InputError for a line that no text has: longer than 16 MB. */
  bool next();

  std::string_view line() const { return line_; }
  uint64_t number() const { return number_; }  ///< from 1
  const std::string& file() const { return file_; }
  const std::string& damage() const { return source_.damage(); }
  double fractionRead() const;

 private:
  bool refill();

  std::string file_;
  ByteSource source_;
  std::vector<char> block_;
  std::size_t begin_ = 0, end_ = 0;
  std::string line_;
  uint64_t number_ = 0;
};

/** Calls `read` for each line that is neither blank nor a comment (#). A LineError that it throws goes to the
 * report as a damaged line, so does what is wrong with the packing; reading goes on.
 * @param report null: damage is passed over, because another pass reports it */
void forEachLine(const std::string& file, const std::function<void(std::string_view)>& read,
                 ImportReport* report, const ProgressCallback& progress);

}  // namespace submap_slam
