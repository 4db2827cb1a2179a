#include "stop_signal.h"

#include <atomic>
#include <csignal>

namespace submap_slam {
namespace {

// A signal handler has no other way to hand anything over than an object with static storage.
std::atomic<bool>& stopFlag() {
  static std::atomic<bool> flag{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");
  return flag;
}

}  // namespace

void catchStopSignals() {
  stopFlag() = false;  // constructed here, not in the handler
  struct sigaction action = {};
  action.sa_handler = [](int) { stopFlag() = true; };
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() { return stopFlag(); }

}  // namespace submap_slam
