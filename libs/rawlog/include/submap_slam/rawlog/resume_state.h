#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace submap_slam {

/** Side-car of a file of submaps, `<file>.resume.json`: which run makes the file and how far it has come. */
struct ResumeState {
  // identity of the run
  std::string version;      ///< of the program
  std::string config_hash;  ///< of every parameter that the submaps depend on
  std::string log;          ///< name of the rawlog, without its folder
  uint64_t log_bytes = 0;   ///< size of the rawlog
  std::string log_hash;     ///< of both ends of the rawlog, see endsHash

  // progress
  uint64_t stretches_done = 0;
  uint64_t submaps_done = 0;
  uint64_t submap_bytes = 0;  ///< size of the file of submaps after them
  bool complete = false;      ///< nothing is left to do
};

/** `<submap_file>.resume.json` */
std::string resumeFileOf(const std::string& submap_file);

/** The side-car of a file of submaps, or nothing if there is none. Throws InputError if it is damaged. */
std::optional<ResumeState> readResumeState(const std::string& submap_file);

/** Replaces the side-car in one step: after a crash either the old or the new one is there. Throws
 * OutputError. */
void writeResumeState(const std::string& submap_file, const ResumeState& state);

/** Text naming the first part of the identity that differs, for example "other parameters"; empty if it is
 * the same run. */
std::string runDifference(const ResumeState& a, const ResumeState& b);

/** textHash of the first and the last megabyte of a file: tells most edits at little cost, also of a file
 * that keeps its size. Throws InputError. */
std::string endsHash(const std::string& file);

/** 16 hex digits (FNV-1a, 64 bits) that identify a text such as the effective configuration. */
std::string textHash(const std::string& text);

}  // namespace submap_slam
