#pragma once

namespace submap_slam {

/** From now on the first Ctrl-C (SIGINT) or SIGTERM only sets a flag, so that the program can end with a
 * valid partial result; the second one ends it at once, with exit code 130. */
void catchStopSignals();

/** True once a stop signal came. */
bool stopRequested();

}  // namespace submap_slam
