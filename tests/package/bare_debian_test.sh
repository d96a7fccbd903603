#!/usr/bin/env bash
# The package as a user has it: bare_debian_test.sh PACKAGE.deb [MIRROR]. lintian looks it through; in a bare Debian 12,
# made by debootstrap, apt installs it, the programs read logs and write a page and its figures from /usr/bin, pages of
# the manual and completions are where Debian searches them, and after its removal no file is left or changed.
# Needs root, debootstrap, lintian and a mirror of Debian. Exits with 77 (skipped) where these are missing.
set -euo pipefail
package=$(realpath "$1")
mirror=${2:-http://deb.debian.org/debian}
source=$(cd "$(dirname "$0")/../.." && pwd)

skip() {
    echo "skipped: $1" >&2
    exit 77
}
fail() {
    echo "bare_debian_test: error: $1" >&2
    exit 1
}
((EUID == 0)) || skip "a Debian of its own needs root"
for tool in debootstrap lintian; do
    command -v "$tool" >/dev/null || skip "$tool is missing (apt-get install $tool)"
done

step() { echo "bare_debian_test: $1" >&2; }

step "lintian"
lintian --fail-on error "$package"

scratch=$(mktemp -d "${TMPDIR:-/tmp}/bare_debian.XXXXXX")
root=$scratch/root
clean_up() {
    ! mountpoint --quiet "$root/proc" || umount "$root/proc"
    rm -rf --one-file-system "$scratch"
}
trap clean_up EXIT

quiet() { "$@" >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log" >&2 && fail "$1 failed"; }; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/usr/sbin:/bin:/sbin HOME=/srv LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

step "a bare Debian 12"
quiet debootstrap --variant=minbase bookworm "$root" "$mirror"
mount -t proc proc "$root/proc" # a program finds its files by /proc/self/exe

# All files of the system with their contents, but those that apt and dpkg keep books in.
files_of() {
    (cd "$root" && find . -xdev \( -path ./proc -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./tmp -o -path ./srv \) -prune \
        -o -printf '%y %m %p %l\n' -type f -exec md5sum {} +) | sort
}

# What it needs and recommends is there before, so that only its own files come and go.
cp "$package" "$root/tmp/flightwatt.deb"
step "what the package needs, by apt"
quiet inside apt-get update
needed=$(dpkg-deb --field "$package" Depends Recommends | sed 's/^[A-Z][a-z]*: //' | tr ',' '\n' | sed -e 's/|.*//' -e 's/(.*//' | tr -d ' ')
mapfile -t needed <<<"$needed"
quiet inside apt-get install --yes --no-install-recommends "${needed[@]}"
files_of >"$scratch/before"

step "installed"
quiet inside apt-get install --yes /tmp/flightwatt.deb
files_of >"$scratch/installed"
[[ $(inside sh -c 'command -v flightwatt') == /usr/bin/flightwatt ]] || fail "there is no /usr/bin/flightwatt"

step "flightwatt batch and report"
cp -r "$source/logs" "$root/srv/logs"
quiet inside flightwatt batch /srv/logs -o /srv/out
quiet inside flightwatt report /srv/out /usr/share/flightwatt/missions/paper/phased.toml -o /srv/report.html --figures /srv/figures
cat "$scratch/log"
grep -q '<details class="flight" id="flight-opterra_synthetic_01"' "$root/srv/report.html" || fail "the page shows no flight"
for ending in vl.json svg pdf; do
    [[ -s $root/srv/figures/flight-opterra_synthetic_01-power.$ending ]] || fail "there is no figure as .$ending"
done

step "every program, its page of the manual and completions"
for program in "$root"/usr/bin/flightwatt*; do
    name=$(basename "$program")
    inside "$name" --version | grep -q . || fail "$name does not start"
    gzip --test "$root/usr/share/man/man1/$name.1.gz" || fail "$name has no page of the manual"
done
for file in bash-completion/completions/flightwatt zsh/site-functions/_flightwatt fish/vendor_completions.d/flightwatt.fish \
    doc/flightwatt/copyright doc/flightwatt/changelog.gz doc/flightwatt/changelog.Debian.gz; do
    [[ -s $root/usr/share/$file ]] || fail "there is no /usr/share/$file"
done

step "removed"
quiet inside apt-get purge --yes flightwatt
files_of >"$scratch/after"
added=$(comm -13 "$scratch/before" "$scratch/installed" | grep -c '^f' || true)
((added > 50)) || fail "only $added files were installed"
diff "$scratch/before" "$scratch/after" >&2 || fail "removed, it leaves what is above"
step "installed, used and removed: $added files came and went"
