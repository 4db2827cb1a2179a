#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/rawlog/resume_state.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "durable_file.h"

namespace submap_slam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ResumeState, version, config_hash, log, log_bytes, log_hash,
                                   stretches_done, submaps_done, submap_bytes, complete)

std::string resumeFileOf(const std::string& submap_file) { return submap_file + ".resume.json"; }

std::optional<ResumeState> readResumeState(const std::string& submap_file) {
  const auto file = resumeFileOf(submap_file);
  if (!std::filesystem::exists(file)) return std::nullopt;
  std::ifstream in(file);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file));
  try {
    return nlohmann::json::parse(in).get<ResumeState>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: expected the state of an interrupted run: {}", file, error.what()));
  }
}

void writeResumeState(const std::string& submap_file, const ResumeState& state) {
  const auto file = resumeFileOf(submap_file);
  const auto next = file + ".new";
  {
    const std::string text = nlohmann::json(state).dump(2) + "\n";
    DurableFile out(next);
    out.cutTo(0);
    out.append(text.data(), text.size());
    out.sync();
  }
  std::error_code error;
  std::filesystem::rename(next, file, error);
  if (error) throw OutputError(fmt::format("{}: cannot be replaced: {}", file, error.message()));
  syncFolderOf(file);
}

std::string runDifference(const ResumeState& a, const ResumeState& b) {
  if (a.version != b.version) return "another version";
  if (a.config_hash != b.config_hash) return "other parameters";
  if (a.log != b.log) return "another log";
  if (a.log_bytes != b.log_bytes) return "a log of another size";
  if (a.log_hash != b.log_hash) return "a log of other content";
  return "";
}

std::string endsHash(const std::string& file) {
  constexpr uint64_t kEndBytes = 1 << 20;
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw InputError(fmt::format("{}: cannot be opened", file));
  const auto size = static_cast<uint64_t>(in.tellg());
  const uint64_t front = std::min(size, kEndBytes), back = std::min(size - front, kEndBytes);
  std::string ends(front + back, '\0');
  in.seekg(0).read(ends.data(), static_cast<std::streamsize>(front));
  in.seekg(static_cast<std::streamoff>(size - back));
  in.read(ends.data() + front, static_cast<std::streamsize>(back));
  if (!in) throw InputError(fmt::format("{}: cannot be read", file));
  return textHash(ends);
}

std::string textHash(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

}  // namespace submap_slam
