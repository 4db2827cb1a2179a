#pragma once

#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/serialization/CArchive.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/import/import.h>

#include <string>
#include <vector>

#include "../support/temp_folder.h"

namespace submap_slam {

/** Text that was imported, and what became of it. */
struct Imported {
  ImportReport report;
  std::vector<mrpt::obs::CObservation::Ptr> objects;

  /** Those of one class, in order. */
  template <class T>
  std::vector<std::shared_ptr<T>> all() const {
    std::vector<std::shared_ptr<T>> found;
    for (const auto& object : objects)
      if (auto one = std::dynamic_pointer_cast<T>(object)) found.push_back(one);
    return found;
  }
};

inline std::vector<mrpt::obs::CObservation::Ptr> readObservations(const std::string& file) {
  mrpt::io::CFileGZInputStream in(file);
  auto archive = mrpt::serialization::archiveFrom(in);
  std::vector<mrpt::obs::CObservation::Ptr> objects;
  try {
    for (;;) objects.push_back(std::dynamic_pointer_cast<mrpt::obs::CObservation>(archive.ReadObject()));
  } catch (const mrpt::serialization::CExceptionEOF&) {
    return objects;
  }
}

inline Imported importText(const std::string& text, const ImportOptions& options = {}) {
  const TempFolder temp;
  Imported result;
  result.report = importFile(temp.write("a.log", text), temp.file("out.rawlog"), options, {});
  result.objects = readObservations(temp.file("out.rawlog"));
  return result;
}

/** What importing the text is refused with; empty: it is not. */
inline std::string refusal(const std::string& text, const ImportOptions& options = {}) {
  try {
    importText(text, options);
  } catch (const InputError& error) {
    return error.what();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

inline double seconds(const mrpt::obs::CObservation& o) { return mrpt::Clock::toDouble(o.timestamp); }

}  // namespace submap_slam
