#!/usr/bin/env bash
# What `cmake --install` makes of a build, by the commands of docs/install.md: installed_test.sh BUILD
# FOLDER. Exits with 77 (skipped) where web/node_modules is missing.
set -euo pipefail
build=$(realpath "$1")
scratch=$2
# shellcheck source=tests/package/helpers.sh
source "$(dirname "$0")/helpers.sh"
[[ -e $source/web/node_modules/.installed-lock.json ]] || skip "web/node_modules is missing"
rm -rf "$scratch"
mkdir -p "$scratch/build"
ln -s "$build" "$scratch/build/release"
cp -r "$source/logs" "$scratch/flights"
answer=$(cd "$scratch" && HOME=$scratch bash -c "$(commands_of cmake)")
has_answer "$answer" "$scratch"
grep -rlF "$source/" "$scratch/.local/lib" "$scratch/.local/share" --include '*.cmake' && fail "they name the sources"
mv "$scratch/.local" "$scratch/moved"
"$scratch/moved/bin/flightwatt-report" "$scratch/flightwatt-out" -o "$scratch/report.html" ||
    fail "moved, it does not find its files"
