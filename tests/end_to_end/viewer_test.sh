#!/usr/bin/env bash
# Drives submap-viewer and MRPT's viewers on a virtual screen and looks at what they show.
#   viewer_test.sh BIN_DIR LIB_DIR SOURCE_DIR WORK_DIR
# Exits with 77 (skipped) where a program or the data set is missing. The pictures stay in WORK_DIR/pictures.
set -euo pipefail
bin=$1 lib=$2 source_dir=$3 work=$4
log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"

skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*" >&2; exit 1; }
for program in xvfb-run xdotool RawLogViewer SceneViewer3D; do
  command -v "$program" >/dev/null || skip "$program is not installed"
done
/usr/bin/python3 -c 'import PIL' 2>/dev/null || skip "python3-pil is not installed"
[[ -f $log ]] || skip "the data set of mrpt-common is not installed"

rm -rf "$work"
mkdir -p "$work/pictures"
pictures=$work/pictures
"$bin/submap-slam" map "$log" -o "$work/run" --quiet --to 120s

echo "--- without a display"
status=0
said=$(env -u DISPLAY -u WAYLAND_DISPLAY "$bin/submap-viewer" "$work/run" 2>&1) || status=$?
echo "$said"
((status == 1)) || fail "exit code $status without a display"
[[ $said == "submap-viewer: error: no display: "*"use --screenshot FILE" ]] || fail "no clear line"
(($(wc -l <<<"$said") == 1)) || fail "one line expected"
env -u DISPLAY "$bin/submap-viewer" "$work/run" --screenshot "$pictures/off-screen.png"
said=$(env -u DISPLAY "$bin/submap-viewer" "$work/run/submaps.rawlog" --join --screenshot "$pictures/joined.png" 2>&1)
[[ $said == "joined: "* ]] || fail "how joining ended was not said: $said"
env -u DISPLAY "$bin/submap-viewer" "$log" --screenshot "$pictures/log.png"
env -u DISPLAY "$bin/submap-viewer" "$source_dir/tests/rawlog/data/submaps_version_0.rawlog" \
  --screenshot "$pictures/old-version.png"

echo "--- landmark submaps"
"$bin/submap-slam" build "$source_dir/rawlogs/landmarks.rawlog" -o "$work/landmarks.rawlog" --quiet
env -u DISPLAY "$bin/submap-viewer" "$work/landmarks.rawlog" --screenshot "$pictures/landmarks.png"
said=$(env -u DISPLAY "$bin/submap-viewer" "$work/landmarks.rawlog" --join --toggle gm \
  --screenshot "$pictures/landmarks-joined.png" 2>&1)
[[ $said == "joined: "* ]] || fail "the landmarks were not joined: $said"

echo "--- what is no rawlog"
echo "This is no log at all." >"$work/text.rawlog"
status=0
said=$(env -u DISPLAY "$bin/submap-viewer" "$work/text.rawlog" --screenshot "$pictures/none.png" 2>&1) || status=$?
echo "$said"
((status == 2)) || fail "exit code $status for a file that is no rawlog"
[[ $said == "submap-viewer: error: "*text.rawlog* ]] || fail "no clear line"
(($(wc -l <<<"$said") == 1)) || fail "one line expected"
[[ ! -e $pictures/none.png ]] || fail "a picture of nothing was made"

echo "--- on a virtual screen"
xvfb-run -a -s "-screen 0 1400x900x24 +extension GLX" \
  "$source_dir/tests/end_to_end/drive_viewers.sh" "$bin" "$lib" "$work/run" "$pictures"

echo "--- what the pictures show"
"$source_dir/tests/end_to_end/look_at_pictures.py" "$pictures"
[[ -s $work/run-edited.edits.txt ]] || fail "the edits were not saved"
grep -qx 'mask 1' "$work/run-edited.edits.txt" || fail "the edit is missing: $(cat "$work/run-edited.edits.txt")"
echo "passed"
