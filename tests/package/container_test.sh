#!/usr/bin/env bash
# The image as a user has it: container_test.sh FLIGHTWATT-container.tar. The commands of docs/install.md. Exits with 77
# (skipped) without podman or without the image.
set -euo pipefail
image=$1
# shellcheck source=tests/package/helpers.sh
source "$(dirname "$0")/helpers.sh"
command -v podman >/dev/null || skip "podman is missing"
[[ -f $image ]] || skip "there is no image"
scratch=$(mktemp -d "${TMPDIR:-/tmp}/container.XXXXXX")
trap 'rm -rf "$scratch"' EXIT
cp -r "$source/logs" "$scratch/flights"
cp "$image" "$scratch"
answer=$(cd "$scratch" && HOME=$scratch bash -c "$(commands_of container)")
has_answer "$answer" "$scratch/flights"
step "loaded and used"
