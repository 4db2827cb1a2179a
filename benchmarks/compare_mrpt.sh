#!/usr/bin/env bash
# CPU time of submap-slam and of MRPT's icp-slam and rbpf-slam on the same log.
#   benchmarks/compare_mrpt.sh LOG_sf.rawlog [SUBMAP_SLAM]
# LOG: actions and sensory frames, the only form that all three read. SUBMAP_SLAM: the program to measure, by default
# that of build/release. MRPT's programs run with the ini files that come with them (Debian: mrpt-common; another
# folder: MRPT_CONFIG_FILES), but show nothing and write their map at the end only, which favours them.
set -euo pipefail

if [[ $# -lt 1 || $# -gt 2 ]]; then
  sed -n '2,3s/^# *//p' "$0" >&2
  exit 2
fi
log=$(realpath "$1")
submap_slam=$(realpath "${2:-$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/submap-slam}")
inis=${MRPT_CONFIG_FILES:-/usr/share/mrpt/config_files}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# cpu_seconds COMMAND...: user and system time of a command, whose output is shown only if it fails.
cpu_seconds() {
  local TIMEFORMAT='%U %S'
  { time "$@" > "$scratch/output" 2>&1; } 2> "$scratch/time" || { tail -n 20 "$scratch/output" >&2; return 1; }
  awk '{ printf "%.1f", $1 + $2 }' "$scratch/time"
}

# quiet_ini INI: prints the name of a copy that shows nothing and writes nothing on the way.
quiet_ini() {
  local name copy
  name=$(basename "$1" .ini)
  copy=$scratch/$name.ini
  sed -E -e 's/\r$//' \
    -e "s|^(logOutput_dir[[:space:]]*=).*|\1$scratch/$name|" \
    -e 's/^((SHOW|SAVE)_[A-Z0-9_]+[[:space:]]*=).*/\10/' \
    -e 's/^(LOG_FREQUENCY[[:space:]]*=).*/\11000000/' \
    -e 's/^(verbosity_level[[:space:]]*=).*/\1ERROR/' "$inis/$1" > "$copy"
  echo "$copy"
}

# report NAME SECONDS
report() { awk -v name="$1" -v s="$2" -v ours="$ours" 'BEGIN { printf "%-52s %8.1f s CPU %7.2f x\n", name, s, s / ours }'; }

ours=$(cpu_seconds "$submap_slam" map "$log" -o "$scratch/submap-slam" --threads 1 --quiet)
report submap-slam "$ours"
while read -r program ini; do
  if ! command -v "$program" > /dev/null || [[ ! -f $inis/$ini ]]; then
    echo "$program with $ini is not installed (Debian: mrpt-apps, mrpt-common)" >&2
    continue
  fi
  seconds=$(cpu_seconds "$program" "$(quiet_ini "$ini")" "$log" < /dev/null)
  report "$program $(basename "$ini")" "$seconds"
done << 'END'
icp-slam icp-slam/icp-slam_demo_classic.ini
rbpf-slam rbpf-slam/gridmapping_RBPF_ICPbased_intel.ini
rbpf-slam rbpf-slam/gridmapping_intel.ini
END
