#!/usr/bin/env bash
# Run by viewer_test.sh and update-pictures on a virtual screen: opens each viewer, drives it, takes pictures.
#   drive_viewers.sh BIN_DIR LIB_DIR RUN_FOLDER PICTURE_FOLDER
set -euo pipefail
bin=$1 lib=$2 run=$3 pictures=$4
plugin=$lib/libsubmap-types.so

HOME=$(mktemp -d)
export HOME
mkdir -p "$HOME/.RawLogViewer"
printf '[tips]\nshow=0\n' >"$HOME/.RawLogViewer/config.cfg"  # else a tip covers the window
started=()
trap 'kill "${started[@]}" 2>/dev/null || true; rm -rf "$HOME"' EXIT

# Takes a picture once the screen shows something and stands still, or else 6 s after it showed something first.
picture() {  # NAME
  /usr/bin/python3 - "$pictures/$1.png" <<'PYTHON'
import sys, time
from PIL import ImageGrab
end, still, last = time.monotonic() + 60, 0, None
shown = False
while still < 3 and time.monotonic() < end:
    time.sleep(0.4)
    seen = ImageGrab.grab(xdisplay="")
    low, high = seen.convert("L").getextrema()
    if low < high and not shown:
        shown, end = True, time.monotonic() + 6
    still = still + 1 if shown and last is not None and seen.tobytes() == last.tobytes() else 0
    last = seen
last.save(sys.argv[1])
PYTHON
}
wait_for_window() {  # NAME
  timeout 60 xdotool search --sync --onlyvisible --name "$1" | head -n 1
}
fill_screen() {  # NAME of the window; there is no window manager to do it
  local window
  window=$(wait_for_window "$1")
  xdotool windowmove "$window" 0 0 windowsize "$window" 1400 900
}
close_viewer() {
  kill "$viewer"
  wait "$viewer" 2>/dev/null || true
}
keys() { xdotool key --delay 150 "$@"; }

echo "submap-viewer"
"$bin/submap-viewer" "$run" --width 1400 --height 900 &
viewer=$!
started+=("$viewer")
wait_for_window submap-viewer >/dev/null
xdotool mousemove 700 400  # no window manager gives the focus
picture viewer-start
xdotool mousemove 400 842 click 1  # the timeline
keys Right Right Page_Down
picture viewer-timeline
keys n n r c
picture viewer-selected
keys d e
for ((i = 0; i < 60; ++i)); do
  if [[ -e $run-edited.edits.txt ]]; then break; fi
  sleep 0.5
done
keys d j
picture viewer-joining
keys m v
picture viewer-joined
keys h
picture viewer-help
kill -0 "$viewer" || { echo "submap-viewer has ended" >&2; exit 1; }
close_viewer

echo "RawLogViewer"
RawLogViewer -l "$plugin" "$run/submaps.rawlog" >/dev/null 2>&1 &
viewer=$!
started+=("$viewer")
fill_screen RawLogViewer
picture rawlogviewer-start
fill_screen RawLogViewer  # it may have sized itself again after the first time
xdotool mousemove 120 250 click 1
picture rawlogviewer
close_viewer

echo "SceneViewer3D, without the plugin"
SceneViewer3D "$run/map.3Dscene" >/dev/null 2>&1 &
viewer=$!
started+=("$viewer")
fill_screen SceneViewer
picture sceneviewer-start
fill_screen SceneViewer
xdotool mousemove 700 450 click --repeat 26 --delay 60 5  # the wheel, away from the map
picture sceneviewer
close_viewer
