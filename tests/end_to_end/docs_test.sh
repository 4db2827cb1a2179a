#!/usr/bin/env bash
# The documentation agrees with the program: generated texts are up to date; commands, options and ini keys that it shows
# exist; files that it points to are there.
#   docs_test.sh PROGRAM SOURCE_DIR
set -euo pipefail
program=$1 source_dir=$2
cd "$source_dir"
pages=(README.md CONTRIBUTING.md docs/*.md plugins/*/README.md rawlogs/README.md)

failures=0
fail() { echo "FAILED: $*" >&2; ((++failures)); }

scripts/update-docs --check "$program" || fail "generated texts are out of date"

# Command lines in blocks of code as "PAGE<tab>submap-slam ...", but those that are shown to end in an error.
commands() {
  for page in "${pages[@]}"; do
    awk -v page="$page" '
      function flush() { if (command != "") print page "\t" command; command = "" }
      /^ *submap-slam: error/ { command = "" }
      { flush() }
      match($0, /^    +(\$ )?([^ `]*\/)?submap-slam /) { command = "submap-slam " substr($0, RLENGTH + 1) }
      END { flush() }' "$page"
  done
}

own_help=$("$program" --help)
declare -A help_of
read_help() {  # SUBCOMMAND, or nothing for the program's own; sets `help`
  help=$own_help
  if [[ -z $1 ]]; then return; fi
  grep -qE "^  $1 " <<<"$own_help" || return 1
  if [[ -z ${help_of[$1]:-} ]]; then help_of[$1]=$("$program" "$1" --help); fi
  help=${help_of[$1]}
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$program" simulate room -o "$scratch/simulated" --quiet  # its ini file has the keys of [simulation]
keys=$({ "$program" parameters --ini && cat "$scratch/simulated.ini"; } |
  awk -F'[][ ]' '/^\[/ {section = $2} /^[a-z]/ {print section "." $1}')

check_command() {  # PAGE LINE
  local page=$1 subcommand="" help=""
  local -a words
  read -ra words <<<"${2%%#*}"
  if [[ ${words[1]} != -* ]]; then subcommand=${words[1]}; fi
  if ! read_help "$subcommand"; then
    fail "$page: no subcommand '$subcommand'"
    return
  fi
  for word in "${words[@]:1}"; do
    case $word in
      -[a-zA-Z] | --[a-z]*)
        grep -qE -- "(^|[ ,])$word([ ,]|\$)" <<<"$help" || fail "$page: no option $word in: $2" ;;
      [a-z_]*.[a-z_]*=*)
        grep -qxF -- "${word%%=*}" <<<"$keys" || fail "$page: no ini key ${word%%=*}" ;;
    esac
  done
}

count=0
while IFS=$'\t' read -r page line; do
  check_command "$page" "$line"
  ((++count))
done < <(commands)
((count >= 20)) || fail "only $count commands were found; is the search still right?"

while IFS=$'\t' read -r page target; do
  [[ -e $(dirname "$page")/${target%%#*} ]] || fail "$page points to $target, which does not exist"
done < <(for page in "${pages[@]}"; do
  { grep -oE '\]\([^)]+\)' "$page" || true; } | sed -E 's/^\]\(|\)$//g' | { grep -vE '^(https?:|#)' || true; } | sed "s|^|$page\t|"
done)

while read -r script; do
  [[ -x $script ]] || fail "README.md names $script, which cannot be run"
done < <(grep -oE '\bscripts/[a-z-]+' README.md | sort -u)

((failures == 0)) || exit 1
echo "passed: $count commands"
