#include "stop_signal.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "common_options.h"

namespace submap_slam {
namespace {

// A signal handler has no other way to hand anything over than an object with static storage.
std::atomic<bool>& stopFlag() {
  static std::atomic<bool> flag{false};
  static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");
  return flag;
}

void onStopSignal(int) {
  if (stopFlag().exchange(true)) _exit(kInterrupted);
}

}  // namespace

void catchStopSignals() {
  stopFlag() = false;  // constructed here, not in the handler
  struct sigaction action = {};
  action.sa_handler = onStopSignal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() { return stopFlag(); }

}  // namespace submap_slam
