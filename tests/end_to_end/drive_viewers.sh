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

picture() { /usr/bin/python3 -c 'import sys; from PIL import ImageGrab; ImageGrab.grab(xdisplay="").save(sys.argv[1])' "$pictures/$1.png"; }
wait_for_window() {  # NAME
  timeout 60 xdotool search --sync --onlyvisible --name "$1" | head -n 1
}
keys() { xdotool key --delay 120 "$@"; sleep 1; }

echo "submap-viewer"
"$bin/submap-viewer" "$run" --width 1400 --height 900 &
viewer=$!
started+=("$viewer")
wait_for_window submap-viewer >/dev/null
xdotool mousemove 700 400  # no window manager gives the focus
sleep 3
picture viewer-start
xdotool mousemove 400 842 click 1  # the timeline
sleep 1
keys Right Right Page_Down
picture viewer-timeline
keys n n r c
picture viewer-selected
keys d e
keys d j
sleep 10
keys m v
picture viewer-joined
keys h
picture viewer-help
kill -0 "$viewer" || { echo "submap-viewer has ended" >&2; exit 1; }
kill "$viewer"
wait "$viewer" 2>/dev/null || true

echo "RawLogViewer"
RawLogViewer -l "$plugin" "$run/submaps.rawlog" >/dev/null 2>&1 &
viewer=$!
started+=("$viewer")
wait_for_window RawLogViewer >/dev/null
sleep 6
xdotool mousemove 120 250 click 1
sleep 3
picture rawlogviewer
kill "$viewer"
wait "$viewer" 2>/dev/null || true

echo "SceneViewer3D, without the plugin"
SceneViewer3D "$run/map.3Dscene" >/dev/null 2>&1 &
viewer=$!
started+=("$viewer")
sleep 8
picture sceneviewer
kill "$viewer"
wait "$viewer" 2>/dev/null || true
