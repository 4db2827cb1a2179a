#pragma once

#include <submap_slam/core/local_mapper.h>
#include <submap_slam/landmarks/pole_detector.h>
#include <submap_slam/mapping/stretch_splitter.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <optional>
#include <string>

namespace submap_slam {

/** Reads a log as stretches. What comes before a damage in the log is delivered like a whole log. */
class StretchSource {
 public:
  /** Throws InputError if the log cannot be opened or holds no scan before its end or first damage.
   * @param detector if it is enabled, poles in the scans become landmarks */
  StretchSource(const std::string& log, const ReaderParams& reader, StretchSplitter splitter,
                const PoleDetectorParams& detector);

  /** The next stretch; nothing at the end of the log or of its undamaged part. */
  std::optional<Stretch> next();

  /** What is wrong with the log where reading had to end; empty if it was read to its end. */
  const std::string& damage() const { return damage_; }

  /** Share of the log that was read, [0, 1]. */
  double fractionRead() const { return reader_.fractionRead(); }

  /** Frames read so far. */
  std::size_t frames() const { return frames_; }

  const LogReport& report() const { return reader_.report(); }

 private:
  std::optional<Frame> nextFrame();

  RawlogReader reader_;
  StretchSplitter splitter_;
  PoleDetectorParams detector_;
  std::optional<Frame>
      first_;  ///< read ahead, so that a log without scans is refused before anything is written
  std::size_t frames_ = 0;
  bool ended_ = false;
  std::string damage_;
};

}  // namespace submap_slam
