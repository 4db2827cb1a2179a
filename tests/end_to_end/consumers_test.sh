#!/usr/bin/env bash
# Other programs can use what a run writes: maps rooms and lets MRPT's own programs load the results. A program that is
# not installed is skipped with a message.
#   consumers_test.sh PROGRAM TYPES_LIBRARY RAWLOG
set -euo pipefail
program=$1 types_library=$2 rawlog=$3
work_dir=$(mktemp -d)
trap 'rm -rf "$work_dir"' EXIT
results=$work_dir/results

fail() { echo "FAILED: $*" >&2; exit 1; }
installed() {
  command -v "$1" >/dev/null && return
  echo "skipped: $1 is not installed"
  return 1
}

load_ros_map() {
  # Class, size, limits and resolution are the first 60 bytes of MRPT's grid file.
  ros-map-yaml2mrpt -i "$results/map.yaml" -d "$work_dir"
  cmp -n 60 <(gunzip -c "$results/map.gridmap.gz") <(gunzip -c "$work_dir/map.gridmap.gz") ||
    fail "the map from map.yaml has another size, place or resolution"
}

# The stock configuration with our map and log, a start within a metre and no window.
localization_config() {
  sed -E \
    -e "s|^map_file=.*|map_file=$results/map.simplemap|" \
    -e "s|^rawlog_file=.*|rawlog_file=$rawlog|" \
    -e "s|^logOutput_dir=.*|logOutput_dir=$work_dir/localization|" \
    -e 's|^(particles_count\|KLD_maxSampleSize)=.*|\1=3000|' \
    -e 's|^init_PDF_min_([xy])=.*|init_PDF_min_\1=-1|' \
    -e 's|^init_PDF_max_([xy])=.*|init_PDF_max_\1=1|' \
    -e 's|^3DSceneFrequency=.*|3DSceneFrequency=-1|' \
    -e 's|^SHOW_PROGRESS_3D_REAL_TIME *=.*|SHOW_PROGRESS_3D_REAL_TIME=false|' "$1"
}

localize() {
  local stock=/usr/share/mrpt/config_files/pf-localization/localization_demo_obsonly_rawlog.ini
  if [[ ! -f $stock ]]; then
    echo "skipped: $stock is missing"
    return
  fi
  localization_config "$stock" >"$work_dir/localization.ini"
  pf-localization "$work_dir/localization.ini" </dev/null >"$work_dir/localization.log" 2>&1 ||
    fail "pf-localization: $(tail -n 5 "$work_dir/localization.log")"
  local found ours
  found=$(sed -nE 's/.*PDF estimation: \(([^,]+),([^,]+),([^d]+)deg\).*/\1 \2 \3/p' "$work_dir/localization.log" | tail -n 1)
  ours=$(tail -n 1 "$results/trajectory.tum" | awk '{print $2, $3, 2 * atan2($7, $8) * 45 / atan2(1, 1)}')
  echo "last pose (m, m, deg): localized in our map $found, ours $ours"
  awk -v found="$found" -v ours="$ours" 'BEGIN {
    if (split(found, f, " ") != 3 || split(ours, o, " ") != 3) exit 1
    turn = f[3] - o[3]
    while (turn > 180) turn -= 360
    while (turn < -180) turn += 360
    exit !(sqrt((f[1] - o[1]) ^ 2 + (f[2] - o[2]) ^ 2) < 0.5 && turn > -5 && turn < 5)
  }' || fail "localized elsewhere"
}

list_submaps() {
  local submaps said
  submaps=$(sed -nE 's/.*"submaps": ([0-9]+).*/\1/p' "$results/metrics.json")
  said=$(rawlog-edit -i "$results/submaps.rawlog" -p "$types_library" --info)
  grep -E "^Overall number of objects +: $submaps\$" <<<"$said" || fail "$submaps submaps expected in: $said"
}

# Runs a window program on a virtual screen until something is drawn there; fails if it ends by itself or complains. The
# screen's file is zeros until then, so that its compressed size tells.
expect_window() {  # PROGRAM ARGUMENT...
  local home=$work_dir/home-$1
  mkdir -p "$home/.RawLogViewer" "$home/screen"
  printf '[tips]\nshow=0\n' >"$home/.RawLogViewer/config.cfg" # the tip would cover everything
  # shellcheck disable=SC2016
  HOME=$home timeout 120 xvfb-run -a -s "-screen 0 1280x800x24 +extension GLX -fbdir $home/screen" bash -c '
    "$@" &
    for ((second = 0; second < 60; ++second)); do
      sleep 1
      kill -0 $! 2>/dev/null || exit 1
      drawn=$(gzip -c "$HOME/screen/Xvfb_screen0" | wc -c)
      if ((second >= 5 && drawn > 10000)); then kill $!; echo "drawn: $drawn bytes"; exit 0; fi
    done
    kill $!
    exit 2' _ "$@" 2>"$home/errors" || fail "$1 ended or drew nothing: $(tail -n 5 "$home/errors")"
  ! grep -qi exception "$home/errors" || fail "$1: $(grep -i -A 1 exception "$home/errors")"
}

"$program" map "$rawlog" -o "$results" --quiet

echo "--- ros-map-yaml2mrpt"
if installed ros-map-yaml2mrpt; then load_ros_map; fi
echo "--- pf-localization"
if installed pf-localization; then localize; fi
echo "--- rawlog-edit"
if installed rawlog-edit; then list_submaps; fi
echo "--- SceneViewer3D"
if installed xvfb-run && installed SceneViewer3D; then expect_window SceneViewer3D "$results/map.3Dscene"; fi
echo "--- RawLogViewer"
if installed xvfb-run && installed RawLogViewer; then
  expect_window RawLogViewer -l "$types_library" "$results/submaps.rawlog"
fi
echo "passed"
