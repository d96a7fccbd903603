#!/usr/bin/env bash
# Packages as a user has them: bare_debian_test.sh PACKAGE... (.deb, .whl), by the commands of docs/install.md in a bare
# Debian 12 of debootstrap. A .deb: lintian reads it; apt installs it, programs write a page and figures, manual and
# completions are where Debian searches them, and after its removal no file is left or changed. A wheel: pip installs it
# without a network; program, page and Python module work, and pip removes it.
# Needs root, debootstrap, a mirror of Debian (MIRROR) and for a .deb lintian, or exits with 77 (skipped). CACHE names a
# folder that keeps what debootstrap fetches.
set -euo pipefail
mapfile -t packages < <(realpath "$@")
# shellcheck source=tests/package/helpers.sh
source "$(dirname "$0")/helpers.sh"
((EUID == 0)) || skip "a Debian of its own needs root"
command -v debootstrap >/dev/null || skip "debootstrap is missing (apt-get install debootstrap)"

scratch=$(mktemp -d "${TMPDIR:-/tmp}/bare_debian.XXXXXX")
root=$scratch/root
clean_up() {
    ! mountpoint --quiet "$root/proc" || umount "$root/proc"
    rm -rf --one-file-system "$scratch"
}
trap clean_up EXIT

quiet() { "$@" >"$scratch/log" 2>&1 || { tail -n 20 "$scratch/log" >&2 && fail "$* failed"; }; }
inside() {
    chroot "$root" /usr/bin/env --ignore-environment --chdir /srv PATH=/usr/bin:/usr/sbin:/bin:/sbin HOME=/srv \
        LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
}

# All files of the system with their contents, but those that apt and dpkg keep books in.
files_of() {
    (cd "$root" && find . -xdev \( -path ./proc -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache \
        -o -path ./var/log -o -path ./tmp -o -path ./srv \) -prune \
        -o -printf '%y %m %p %l\n' -type f -exec md5sum {} +) | sort
}

# The commands of docs/install.md answer; how long they take is shown.
use() {
    local start=$SECONDS answer
    answer=$(inside bash -c "$(commands_of "$1")" 2>"$scratch/log") || {
        cat "$scratch/log" >&2
        fail "commands of docs/install.md: $1"
    }
    has_answer "$answer" "$root/srv"
    step "$1: installed and used in $((SECONDS - start)) s"
}

test_deb() {
    local package=$1 needed added program name file
    if command -v lintian >/dev/null; then
        lintian --fail-on error "$package"
    else
        skipped="lintian is missing (apt-get install lintian)"
    fi
    # What it needs and recommends is there before, so that only its own files come and go.
    step "what the package needs, by apt"
    mapfile -t needed < <(dpkg-deb --field "$package" Depends Recommends |
        sed 's/^[A-Z][a-z]*: //' | tr ',' '\n' | sed -e 's/|.*//' -e 's/(.*//' | tr -d ' ')
    quiet inside apt-get install --yes --no-install-recommends "${needed[@]}"
    files_of >"$scratch/before"
    use deb
    files_of >"$scratch/installed"
    [[ $(inside sh -c 'command -v flightwatt') == /usr/bin/flightwatt ]] || fail "there is no /usr/bin/flightwatt"

    step "batch, and report with figures"
    quiet inside flightwatt batch flights -o out
    quiet inside flightwatt report out /usr/share/flightwatt/missions/paper/phased.toml -o report.html --figures figures
    grep -q opterra_synthetic_01 "$root/srv/report.html" || fail "the page shows no flight"
    for file in vl.json svg pdf; do
        [[ -s $root/srv/figures/flight-opterra_synthetic_01-power.$file ]] || fail "there is no figure as .$file"
    done

    step "every program, its page of the manual and completions"
    for program in "$root"/usr/bin/flightwatt*; do
        name=$(basename "$program")
        inside "$name" --version | grep -q . || fail "$name does not start"
        gzip --test "$root/usr/share/man/man1/$name.1.gz" || fail "$name has no page of the manual"
    done
    for file in bash-completion/completions/flightwatt zsh/site-functions/_flightwatt \
        fish/vendor_completions.d/flightwatt.fish doc/flightwatt/{copyright,changelog.gz,changelog.Debian.gz}; do
        [[ -s $root/usr/share/$file ]] || fail "there is no /usr/share/$file"
    done

    quiet inside apt-get purge --yes flightwatt
    files_of >"$scratch/after"
    added=$(comm -13 "$scratch/before" "$scratch/installed" | grep -c '^f' || true)
    ((added > 50)) || fail "only $added files were installed"
    diff "$scratch/before" "$scratch/after" >&2 || fail "removed, it leaves what is above"
    step "removed: $added files came and went"
}

test_wheel() {
    local pip=venv/bin/pip left
    step "python3-venv, by apt"
    quiet inside apt-get install --yes --no-install-recommends python3-venv
    rm -rf "$root/srv/flightwatt-out"
    use wheel
    inside venv/bin/flightwatt --version | grep -q . || fail "flightwatt does not start"
    quiet inside "$pip" check
    quiet inside "$pip" uninstall --yes flightwatt
    left=$(find "$root/srv/venv" -path '*flightwatt*' ! -type d) # pip leaves folders
    [[ -z $left ]] || fail "removed, it leaves $left"
}

step "a bare Debian 12"
quiet debootstrap --variant=minbase ${CACHE:+--cache-dir="$CACHE"} bookworm "$root" \
    "${MIRROR:-http://deb.debian.org/debian}"
mount -t proc proc "$root/proc"
quiet inside apt-get update
cp -r "$source/logs" "$root/srv/flights"
cp "${packages[@]}" "$root/srv"
skipped=
for package in "${packages[@]}"; do
    case $package in
    *.deb) test_deb "$package" ;;
    *.whl) test_wheel ;;
    *) fail "neither .deb nor .whl: $package" ;;
    esac
done
[[ -z $skipped ]] || skip "$skipped"
