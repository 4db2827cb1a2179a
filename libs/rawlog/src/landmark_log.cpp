#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <zlib.h>

#include <sstream>

#include <submap_slam/rawlog/byte_source.h>
#include "landmark_text.h"
#include "object_stream.h"

namespace submap_slam {
namespace {

/** Behind blank lines and comments. */
bool beginsAsText(const std::string& file) {
  constexpr std::size_t kFront = 1 << 14;  // room for comments
  std::istringstream front(ByteSource(file).peek(kFront));
  std::string word;
  while (front >> word && word.front() == '#') std::getline(front, word);
  return word == "MAP";
}

bool beginsAsRawlog(const std::string& file) {
  return ByteSource(file).peek(64).find("LandmarkSubmap") != std::string::npos;
}

std::string contentOf(const std::string& file) {
  ByteSource source(file);
  std::string content;
  constexpr std::size_t kBlock = 1 << 20;
  while (!source.atEnd()) {
    const std::size_t before = content.size();
    content.resize(before + kBlock);
    content.resize(before + source.read(content.data() + before, kBlock));
  }
  if (!source.damage().empty()) throw InputError(fmt::format("{}: {}", file, source.damage()));
  return content;
}

LandmarkSubmaps readText(const std::string& file) {
  const std::string content = contentOf(file);
  LandmarkText text(file, content);
  LandmarkSubmaps submaps;
  while (auto submap = text.next()) submaps.push_back(std::move(submap));
  return submaps;
}

/** The next submap of a rawlog, or null at its end. Throws InputError naming the entry. */
LandmarkSubmap::Ptr nextOf(ObjectStream& stream, const std::string& file) {
  const auto object = stream.next();
  if (stream.damage()) throw InputError(stream.damage()->text);
  if (!object) return nullptr;
  const std::string entry = fmt::format("{}: entry {}", file, stream.entries() - 1);
  auto submap = std::dynamic_pointer_cast<LandmarkSubmap>(object);
  if (!submap)
    throw InputError(
        fmt::format("{} is a {}, expected a LandmarkSubmap", entry, object->GetRuntimeClass()->className));
  if (stream.cutBehindLast())
    throw InputError(fmt::format("{}: its gzip member is incomplete or corrupt", entry));
  try {
    requireUsable(*submap);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", entry, error.what()));
  }
  return submap;
}

RecoveredLandmarkSubmaps recoverRawlog(const std::string& file) {
  ObjectStream stream(file);
  RecoveredLandmarkSubmaps read;
  try {
    while (auto submap = nextOf(stream, file)) {
      submap->id = static_cast<uint32_t>(read.submaps.size());
      read.submaps.push_back(std::move(submap));
    }
  } catch (const InputError& error) {
    read.damage = error.what();
  }
  return read;
}

}  // namespace

bool holdsLandmarkSubmaps(const std::string& file) { return beginsAsText(file) || beginsAsRawlog(file); }

RecoveredLandmarkSubmaps recoverLandmarkSubmaps(const std::string& file) {
  RecoveredLandmarkSubmaps read;
  if (beginsAsText(file))
    read.submaps = readText(file);
  else
    read = recoverRawlog(file);
  if (read.submaps.empty())
    throw InputError(read.damage.empty() ? fmt::format("{}: holds no submaps", file) : read.damage);
  return read;
}

LandmarkSubmaps readLandmarkSubmaps(const std::string& file) {
  RecoveredLandmarkSubmaps read = recoverLandmarkSubmaps(file);
  if (!read.damage.empty()) throw InputError(read.damage);
  return std::move(read.submaps);
}

void writeLandmarkText(const std::string& file, const LandmarkSubmaps& submaps) {
  const std::string text = landmarkText(submaps), ending = ".gz";
  const bool pack =
      file.size() > ending.size() && file.compare(file.size() - ending.size(), ending.size(), ending) == 0;
  // In mode "T" zlib writes the bytes as they are.
  const gzFile out = gzopen(file.c_str(), pack ? "wb" : "wbT");
  bool written = out != nullptr;
  if (written) written = text.empty() || gzfwrite(text.data(), text.size(), 1, out) == 1;
  if (out != nullptr) written = gzclose(out) == Z_OK && written;
  if (!written) throw OutputError(fmt::format("{}: cannot be written", file));
}

}  // namespace submap_slam
