#pragma once

#include <submap_slam/rawlog/log_report.h>
#include <submap_slam/rawlog/rawlog_reader.h>

#include <string>

namespace submap_slam {

/** Why a log that was read to its end gave no frame, as the rest of a sentence that begins with its name. */
std::string whyNoFrames(const LogReport& report, const ReaderParams& params);

}  // namespace submap_slam
