#include "text_lines.h"

#include <fmt/format.h>
#include <submap_slam/core/errors.h>

#include <algorithm>

#include "words.h"

namespace submap_slam {
namespace {

constexpr std::size_t kBlockBytes = 1 << 16;
constexpr std::size_t kLongestLine = 16 << 20;
constexpr std::size_t kMostDamageShown = 5;
constexpr uint64_t kLinesBetweenProgress = 256;

void addDamage(ImportReport* report, const TextLines& lines, const std::string& what) {
  if (report == nullptr) return;
  if (report->damage.size() < kMostDamageShown)
    report->damage.push_back(fmt::format("{}:{}: {}", lines.file(), lines.number(), what));
}

}  // namespace

TextLines::TextLines(const std::string& file) : file_(file), source_(file), block_(kBlockBytes) {}

bool TextLines::refill() {
  begin_ = 0;
  end_ = source_.read(block_.data(), block_.size());
  return end_ > 0;
}

bool TextLines::next() {
  line_.clear();
  bool any = false;
  while (begin_ < end_ || refill()) {
    any = true;
    const char* const begin = block_.data() + begin_;
    const char* const end = block_.data() + end_;
    const char* const found = std::find(begin, end, '\n');
    line_.append(begin, found);
    begin_ = static_cast<std::size_t>(found - block_.data()) + (found < end ? 1 : 0);
    if (line_.size() > kLongestLine)
      throw InputError(fmt::format("{}:{}: the line does not end; expected a text file", file_, number_ + 1));
    if (found < end) break;
  }
  if (any) ++number_;
  return any;
}

double TextLines::fractionRead() const {
  if (source_.fileSize() == 0) return 1;
  return static_cast<double>(source_.filePosition()) / static_cast<double>(source_.fileSize());
}

void forEachLine(const std::string& file, const std::function<void(std::string_view)>& read,
                 ImportReport* report, const ProgressCallback& progress) {
  TextLines lines(file);
  while (lines.next()) {
    if (lines.number() % kLinesBetweenProgress == 0 && progress && !progress(lines.fractionRead(), "reading"))
      throw Interrupted();
    Words words(lines.line());
    const std::string_view first = words.next();
    if (first.empty() || first.front() == '#') continue;
    try {
      read(lines.line());
    } catch (const LineError& error) {
      if (report != nullptr) ++report->damaged_lines;
      addDamage(report, lines, error.what());
    }
  }
  if (report != nullptr) report->lines += lines.number();
  if (!lines.damage().empty()) addDamage(report, lines, lines.damage() + "; what follows is lost");
  if (progress) progress(1, "reading");
}

}  // namespace submap_slam
