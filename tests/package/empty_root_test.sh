#!/usr/bin/env bash
# The tar as a user has it: empty_root_test.sh FLIGHTWATT.tar.gz [PROGRAM]. The commands of docs/install.md; then, in a
# root folder that has nothing but its files and logs (no /etc, /proc, /dev, /tmp, library or shell), the program
# answers, fits and writes pages, with the results of PROGRAM, a build with shared libraries. Needs root, or exits with
# 77 (skipped).
set -euo pipefail
tar=$(realpath "$1")
program=$(realpath "${2:-/dev/null}")
# shellcheck source=tests/package/helpers.sh
source "$(dirname "$0")/helpers.sh"
((EUID == 0)) || skip "chroot needs root"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/empty_root.XXXXXX")
trap 'rm -rf "$scratch"' EXIT

step "the commands of docs/install.md"
mkdir "$scratch/home"
cp -r "$source/logs" "$scratch/home/flights"
cp "$tar" "$scratch/home"
answer=$(cd "$scratch/home" && HOME=$scratch/home bash -c "$(commands_of tar)")
has_answer "$answer" "$scratch/home"

step "an empty root"
root=$scratch/root
mkdir "$root"
tar --extract --gzip --file "$tar" --directory "$root"
cp -r "$source/logs" "$root"
folder=$(basename "$tar" .tar.gz)
readelf --program-headers --wide "$root/$folder/bin/flightwatt" >"$scratch/headers"
! grep -q INTERP "$scratch/headers" || fail "the program is not static"
inside() {
    local program=$1
    env -i "$(command -v chroot)" "$root" "/$folder/bin/$program" "${@:2}"
}

inside flightwatt --version
has_answer "$(inside flightwatt logs --capacity 5)" "$root"
inside flightwatt batch logs -o out --quiet >"$scratch/static.txt"
inside flightwatt-report out "$folder/share/flightwatt/missions/paper/phased.toml" -o report.html
[[ -s $root/report.html ]] || fail "there is no page"

if [[ -x $program && -f $program ]]; then
    step "the results of the build"
    mkdir "$scratch/build"
    cp -r "$source/logs" "$scratch/build"
    (cd "$scratch/build" && "$program" batch logs -o out --quiet >"$scratch/shared.txt")
    diff "$scratch/shared.txt" "$scratch/static.txt" || fail "batch prints other results than $program"
    diff --recursive --ignore-matching-lines '"place":' "$scratch/build/out" "$root/out" ||
        fail "batch writes other results than $program"
fi
step "answered, fitted and reported without a file of the system"
