#include <submap_slam/pipeline/program_errors.h>

#include <fmt/format.h>
#include <submap_slam/core/errors.h>
#include <submap_slam/pipeline/printable.h>

#include <cstdio>

namespace submap_slam {

int reportError(const std::string& program, const std::string& text, ExitCode exit_code) {
  fmt::print(stderr, "{}: error: {}\n", program, printable(text));
  return exit_code;
}

int reportCaughtError(const std::string& program) {
  try {
    throw;
  } catch (const InputError& e) {
    return reportError(program, e.what(), kBadInput);
  } catch (const ConfigError& e) {
    return reportError(program, e.what(), kBadInput);
  } catch (const PluginError& e) {
    return reportError(program, e.what(), kBadInput);
  } catch (const Interrupted& e) {
    return reportError(program, e.what(), kInterrupted);
  } catch (const std::exception& e) {
    return reportError(program, e.what(), kFailure);
  }
}

}  // namespace submap_slam
