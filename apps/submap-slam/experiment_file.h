/** The lines of an experiment file, and errors that name them. */
#pragma once

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/core/ini_file.h>

#include <string>
#include <vector>

namespace submap_slam {

/** A ConfigError that says in which line already. */
struct ExperimentLineError : ConfigError {
  using ConfigError::ConfigError;
};

/** The lines of an experiment file. */
class ExperimentFile {
 public:
  /** Throws as readIni. */
  explicit ExperimentFile(const std::string& name) : name_(name), entries_(readIni(name)) {}

  const std::vector<IniEntry>& entries() const { return entries_; }

  /** The lines with a key in a section. */
  std::vector<IniEntry> keysOf(const std::string& section) const;

  /** The heading of a section that a list of [experiment] names; throws ConfigError if there is none. */
  const IniEntry& headingOf(const std::string& section, const std::string& list) const;

  /** Calls `read`, whose ConfigErrors get file and line of the entry. */
  template <class Read>
  void at(const IniEntry& entry, Read read) const {
    try {
      read();
    } catch (const ConfigError& e) {
      throw ExperimentLineError(fmt::format("{}:{}: {}", name_, entry.line, e.what()));
    }
  }

 private:
  std::string name_;
  std::vector<IniEntry> entries_;
};

/** A line of [setting NAME] or [data NAME], as "section.key=value". */
std::string assignmentOf(const IniEntry& entry);

/** Names of data and settings become folders. Throws ConfigError for those that cannot. */
void requireName(const std::string& name);

bool startsWith(const std::string& text, const std::string& prefix);

/** The words of a list, separated by commas or blanks. */
std::vector<std::string> wordsOf(std::string text);

}  // namespace submap_slam
