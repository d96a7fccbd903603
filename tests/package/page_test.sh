#!/usr/bin/env bash
# Opens the page with the program in it as a file in Chromium, and uses it: page_test.sh FLIGHTWATT.html. Exits with 77
# (skipped) without a browser.
set -euo pipefail
page=$(realpath "$1")
cd "$(dirname "$0")/../.."
chromium=$(command -v chromium || command -v chromium-browser) || {
    echo "page_test: skipped: chromium is missing" >&2
    exit 77
}
CHROMIUM=$chromium FLIGHTWATT_PAGE=$page node --test --test-reporter=spec web/app/test/app.test.mjs
