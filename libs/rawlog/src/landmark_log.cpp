#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/landmark_log.h>
#include <zlib.h>

#include <submap_slam/rawlog/byte_source.h>
#include "landmark_text.h"
#include "object_stream.h"

namespace submap_slam {
namespace {

bool beginsAsText(const std::string& file) {
  ByteSource source(file);
  const std::string front = source.peek(256);
  const std::size_t word = front.find_first_not_of(" \t\r\n");
  return word != std::string::npos && front.compare(word, 3, "MAP") == 0;
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

LandmarkSubmaps readRawlog(const std::string& file) {
  ObjectStream stream(file);
  LandmarkSubmaps submaps;
  while (const auto object = stream.next()) {
    const auto entry = [&] { return fmt::format("{}: entry {}", file, stream.entries() - 1); };
    auto submap = std::dynamic_pointer_cast<LandmarkSubmap>(object);
    if (!submap)
      throw InputError(fmt::format("{} is a {}, expected a LandmarkSubmap", entry(),
                                   object->GetRuntimeClass()->className));
    try {
      requireUsable(*submap);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", entry(), error.what()));
    }
    submap->id = static_cast<uint32_t>(submaps.size());
    submaps.push_back(std::move(submap));
  }
  if (stream.damage()) throw InputError(stream.damage()->text);
  return submaps;
}

}  // namespace

bool holdsLandmarkSubmaps(const std::string& file) { return beginsAsText(file) || beginsAsRawlog(file); }

LandmarkSubmaps readLandmarkSubmaps(const std::string& file) {
  LandmarkSubmaps submaps = beginsAsText(file) ? readText(file) : readRawlog(file);
  if (submaps.empty()) throw InputError(fmt::format("{}: holds no submaps", file));
  return submaps;
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
