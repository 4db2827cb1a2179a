/** Typed errors: bad input and bad configuration are thrown, numerical outcomes are returned as a status. */
#pragma once

#include <stdexcept>

namespace submap_slam {

/** A file that cannot be read, is truncated or holds something else than expected. The text names file and
 * offset. */
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** An unknown or invalid ini key, value or option. The text names section and key. */
struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** A plugin that cannot be loaded, or a joiner name that no loaded plugin offers. */
struct PluginError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** A result that cannot be written. The text names the file. */
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/** The user asked to stop (Ctrl-C); what was complete is on disk. */
struct Interrupted : std::runtime_error {
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace submap_slam
