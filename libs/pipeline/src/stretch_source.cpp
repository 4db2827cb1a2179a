#include <submap_slam/pipeline/stretch_source.h>

#include <submap_slam/core/errors.h>

#include <utility>

namespace submap_slam {

StretchSource::StretchSource(const std::string& log, const ReaderParams& reader, StretchSplitter splitter,
                             const PoleDetectorParams& detector)
    : reader_(log, reader), splitter_(std::move(splitter)), detector_(detector) {
  first_ = nextFrame();
}

std::optional<Stretch> StretchSource::next() {
  if (ended_) return std::nullopt;
  while (auto frame = first_ ? std::exchange(first_, std::nullopt) : nextFrame()) {
    if (auto stretch = splitter_.push(std::move(*frame))) return stretch;
  }
  ended_ = true;
  return splitter_.finish();
}

std::optional<Frame> StretchSource::nextFrame() {
  try {
    auto frame = reader_.next();
    if (!frame) return frame;
    ++frames_;
    if (detector_.enabled)
      for (const auto& scan : frame->scans) frame->landmark_scans.push_back(poleLandmarks(*scan, detector_));
    return frame;
  } catch (const InputError& e) {
    if (frames_ == 0) throw;  // nothing to keep
    damage_ = e.what();
    return std::nullopt;
  }
}

}  // namespace submap_slam
