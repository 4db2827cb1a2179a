#!/usr/bin/env bash
# Installs the build into an empty prefix, builds the example plugin against that prefix as a user would, and lets the
# installed program load it; then plugins that must be refused.
#   install_test.sh SOURCE_DIR BINARY_DIR WORK_DIR CMAKE CXX
set -euo pipefail
source_dir=$1 binary_dir=$2 work_dir=$3 cmake=$4 cxx=$5

fail() { echo "FAILED: $*" >&2; exit 1; }
expect_text() { grep -q -- "$1" <<<"$2" || fail "'$1' is missing in: $2"; }

build_against_prefix() {  # PROJECT_DIR NAME
  "$cmake" -S "$1" -B "$work_dir/$2" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$cxx" \
    -DCMAKE_BUILD_TYPE=Release
  "$cmake" --build "$work_dir/$2"
}

expect_refused() {  # PLUGIN TEXT
  local said status=0
  said=$("$program" --list-joiners -p "$1" 2>&1) || status=$?
  echo "$said"
  ((status != 0)) || fail "$1 was accepted"
  ((status < 126)) || fail "$1 ended the program with status $status"
  expect_text "$2" "$said"
  expect_text "$(basename "$1")" "$said"
  (($(wc -l <<<"$said") == 1)) || fail "one line expected"
}

rm -rf "$work_dir"
mkdir -p "$work_dir"
"$cmake" --install "$binary_dir" --prefix "$work_dir/first" >/dev/null
# The installation must also work where it was moved to.
prefix=$work_dir/prefix
mv "$work_dir/first" "$prefix"
program=$prefix/bin/submap-slam

echo "--- installed joiners"
joiners=$("$program" --list-joiners)
echo "$joiners"
expect_text grid_gauss_newton "$joiners"
! grep -q chain_only <<<"$joiners" || fail "chain_only is listed before it was built"

echo "--- example plugin, given with -p"
build_against_prefix "$source_dir/examples/joiner_plugin" example
joiners=$("$program" --list-joiners -p "$work_dir/example/chain_only.so")
echo "$joiners"
expect_text chain_only "$joiners"
expect_text grid_gauss_newton "$joiners"

echo "--- example plugin, installed"
# DESTDIR catches a plugin folder outside the prefix before anything is written there.
DESTDIR=$work_dir/staged "$cmake" --install "$work_dir/example"
[[ -n $(find "$work_dir/staged$prefix" -path '*/submap-slam/plugins/chain_only.so') ]] ||
  fail "the plugin folder is not below $prefix"
cp -r "$work_dir/staged$prefix/." "$prefix"
expect_text chain_only "$("$program" --list-joiners)"

echo "--- plugins that must be refused"
build_against_prefix "$source_dir/tests/end_to_end/refused_plugins" refused
expect_refused "$work_dir/refused/other_interface.so" "interface"
expect_refused "$work_dir/refused/no_plugin.so" "not a submap-slam plugin"
expect_refused "$work_dir/missing.so" "no such file"
echo "no library" >"$work_dir/text.so"
expect_refused "$work_dir/text.so" "cannot be loaded"

echo "--- types library as an MRPT plugin"
[[ -n $(find "$prefix" -name libsubmap-types.so) ]] || fail "libsubmap-types.so is not installed"

echo "--- viewers"
for file in bin/submap-viewer bin/submap-rawlogviewer share/applications/submap-viewer.desktop share/mime/packages/submap-slam.xml; do
  [[ -e $prefix/$file ]] || fail "$file is not installed"
done
library=$(grep -o '\.\./[^"]*\.so' "$prefix/bin/submap-rawlogviewer")
[[ -n $library && -e $prefix/bin/$library ]] || fail "submap-rawlogviewer names no installed library: '$library'"
echo "passed"
