#!/usr/bin/env bash
# The page of flightwatt watch in Chromium: live_page_test.sh BIN WEB SCRATCH. Exits with 77 (skipped) where node, its
# modules or Chromium are missing.
set -euo pipefail
bin=$1
web=$2
scratch=$3
source=$(cd "$(dirname "$0")/../.." && pwd)

skip() {
    echo "skipped: $1 is missing; scripts/install_dependencies build tests installs it" >&2
    exit 77
}
command -v node >/dev/null || skip node
[[ -d $web/node_modules/playwright-core && -d $web/node_modules/esbuild ]] || skip web/node_modules
chromium=$(command -v chromium || command -v chromium-browser) || skip chromium

rm -rf "$scratch"
mkdir -p "$scratch"
port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
BIN=$bin SOURCE=$source SCRATCH=$scratch PORT=$port WEB=$web CHROMIUM=$chromium \
    node --test --test-reporter=spec "$source/tests/report/live_page_test.mjs"
