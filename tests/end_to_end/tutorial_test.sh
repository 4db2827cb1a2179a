#!/usr/bin/env bash
# Runs the commands of docs/tutorial.md in their order, as a newcomer types them, in a folder of its own. Each must end as
# shown: with an error where the text shows one, otherwise well. Windows are not opened, and nobody presses Ctrl-C.
#   tutorial_test.sh PROGRAM SOURCE_DIR [--show]      --show: print what the commands print, to bring the text up to date
set -euo pipefail
program=$(realpath "$1") source_dir=$(realpath "$2") show=${3:-}
work_dir=$(mktemp -d)
trap 'rm -rf "$work_dir"' EXIT
cd "$work_dir"
ln -s "$source_dir/rawlogs" "$source_dir/ini" "$source_dir/docs" "$source_dir/scripts" .
mkdir -p build && ln -s "$(dirname "$(dirname "$program")")" build/release
PATH=$(dirname "$program"):$PATH

failures=0
fail() { echo "FAILED: $*" >&2; ((++failures)); }

# The commands of the page, each as a line "$ COMMAND" with what the page shows below it; blocks end at a line of text.
shown() { awk '/^    / { print substr($0, 5); next } { print "" }' "$source_dir/docs/tutorial.md"; }

is_window() { [[ $1 != *" --screenshot "* && $1 =~ ^(RawLogViewer|SceneViewer3D|submap-viewer|submap-rawlogviewer|xdg-open|firefox)\  ]]; }

# A file that the page shows with cat, and that the reader is to write.
write_shown() {  # COMMAND OUTPUT
  local file=${1#cat }
  if [[ $1 == "cat "* && $file != *" "* && ! -e $file ]]; then printf '%s\n' "$2" | sed '/^$/d' >"$file"; fi
}

check_command() {  # COMMAND OUTPUT
  local command=$1 output=$2 expected=0 status=0
  if is_window "$command"; then return; fi
  if ! command -v "${command%% *}" >/dev/null; then
    echo "skipped, ${command%% *} is not installed: $command"
    return
  fi
  write_shown "$command" "$output"
  if grep -q '^submap-slam: error' <<<"$output"; then expected=2; fi
  bash -o pipefail -c "$command" >out.txt 2>&1 </dev/null || status=$?
  ((status == expected)) || fail "exit code $status instead of $expected: $command"$'\n'"$(tail -n 5 out.txt)"
  if [[ $show == --show ]]; then printf '$ %s\n' "$command" && cat out.txt; fi
}

count=0 command="" output=""
flush() {
  if [[ -z $command ]]; then return; fi
  if ! grep -qxF '^C' <<<"$output"; then check_command "$command" "$output" && ((++count)); fi
  command="" output=""
}
while IFS= read -r line; do
  if [[ $line == '$ '* ]]; then
    flush
    command=${line#'$ '}
  elif [[ -n $command ]]; then
    output+=$line$'\n'
  fi
done < <(shown)
flush

((count >= 20)) || fail "only $count commands were found; is the search still right?"
((failures == 0)) || exit 1
echo "passed: $count commands"
