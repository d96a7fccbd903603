#!/usr/bin/env bash
# Compares the documents of pages with their types: document_test.sh BIN WEB SCRATCH. Exits with 77 (skipped) where the
# compiler of TypeScript is missing.
set -euo pipefail
bin=$1
web=$2
scratch=$3
source=$(cd "$(dirname "$0")/../.." && pwd)

[[ -x $web/node_modules/.bin/tsc && -d $web/node_modules/esbuild ]] || {
    echo "skipped: web/node_modules is missing; scripts/install_dependencies build tests installs it" >&2
    exit 77
}
rm -rf "$scratch"
mkdir -p "$scratch"
quiet() { "$@" >"$scratch/stdout" 2>"$scratch/stderr" || { cat "$scratch/stderr" >&2 && exit 1; }; }

quiet "$bin/flightwatt-batch" "$source/logs" -o "$scratch/six"
mkdir "$scratch/web"
cp "$bin/../share/flightwatt/web"/app.{js,css} "$scratch/web"
echo "no module" >"$scratch/web/flightwatt.wasm.gz"
FLIGHTWATT_WEB=$scratch/web quiet "$bin/flightwatt-report" "$scratch/six" "$source"/missions/paper/{phased,plan}.toml \
    "$source"/missions/synthetic/{survey-path,several-packs}.toml --interactive -o "$scratch/report.html"
quiet "$bin/flightwatt" "$source/logs" --capacity 3.2 -o "$scratch/answer"
mv "$scratch/answer/answer.html" "$scratch/answer.html"

for page in report answer; do
    {
        echo "import type { ReportDocument } from \"$web/app/src/documents\";"
        echo 'export const document: ReportDocument ='
        sed -n 's|.*<script type="application/json" id="document">\(.*\)</script>.*|\1|p' "$scratch/$page.html"
    } >"$scratch/$page.ts"
    "$web/node_modules/.bin/tsc" --noEmit --strict --skipLibCheck --target ES2022 --lib ES2022,DOM,DOM.Iterable \
        --module ESNext --moduleResolution Bundler "$scratch/$page.ts" | cut -c 1-300
done
