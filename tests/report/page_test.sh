#!/usr/bin/env bash
# Makes the pages of page_test.mjs and opens them in Chromium: page_test.sh BIN WEB SCRATCH. Exits with 77 (skipped)
# where node, its modules or Chromium are missing.
set -euo pipefail
bin=$1
web=$2
pages=$3
source=$(cd "$(dirname "$0")/../.." && pwd)

skip() {
    echo "skipped: $1 is missing; scripts/install_dependencies installs it" >&2
    exit 77
}
command -v node >/dev/null || skip node
[[ -d $web/node_modules/playwright-core && -d $web/node_modules/vega ]] || skip web/node_modules
chromium=$(command -v chromium || command -v chromium-browser) || skip chromium

rm -rf "$pages"
mkdir -p "$pages/hostile" "$pages/three_hundred"
quiet() { "$@" >/dev/null 2>"$pages/stderr" || { cat "$pages/stderr" >&2 && exit 1; }; }

quiet "$bin/flightwatt-batch" "$source/logs" -o "$pages/six"
quiet "$bin/flightwatt-report" "$pages/six" "$source"/missions/paper/*.toml -o "$pages/six.html"
"$bin/flightwatt-report" "$pages/six" "$source"/missions/paper/*.toml --json >"$pages/six.json" 2>/dev/null

# Two folders on one page: one flight is in both.
quiet "$bin/flightwatt-batch" "$source"/logs/opterra_synthetic_0[1-2].data -o "$pages/first"
quiet "$bin/flightwatt-batch" "$source"/logs/opterra_synthetic_0[2-3].data --order 2 -o "$pages/second"
quiet "$bin/flightwatt-report" "$pages/first" "$pages/second" "$source"/missions/paper/phased.toml -o "$pages/folders.html"

# Names that a page must not believe.
log=$source/logs/opterra_synthetic_01
names=('<script>window.hacked=1<:script>' '"quoted" & '"'single'" 'αβγ ✈ 無人機' "$(printf 'f%.0s' {1..230})" '</script' '-->')
for name in "${names[@]}"; do
    name=${name//\//:}
    cp "$log.data" "$pages/hostile/$name.data"
    cp "$log.log" "$pages/hostile/$name.log"
done
mission() {
    sed -e "s|^name = .*|name = '''$2'''|" -e "s|\"../../|\"$source/|" "$source/missions/paper/phased.toml" >"$pages/hostile/$1.toml"
}
mission markup '</script><script>window.hacked=1</script><!-- "quoted"'
mission long "$(printf 'm%.0s' {1..300})"
mission unicode 'αβγ ✈ 無人機'
mission twice 'αβγ ✈ 無人機'
quiet "$bin/flightwatt-batch" "$pages/hostile" -o "$pages/hostile_out"
quiet "$bin/flightwatt-report" "$pages/hostile_out" "$pages"/hostile/*.toml --title '<b>"title"</b>' -o "$pages/hostile.html"

quiet "$bin/flightwatt-synthesize" "$source/fits/mechanical/opterra-table1.toml" --flights 300 --seed 3 -o "$pages/three_hundred"
quiet "$bin/flightwatt-batch" "$pages/three_hundred" -o "$pages/three_hundred_out"
quiet "$bin/flightwatt-report" "$pages/three_hundred_out" "$source"/missions/paper/*.toml -o "$pages/three_hundred.html"

# As many flights as are compressed, and their figures as files: without node, specifications alone.
quiet "$bin/flightwatt-batch" "$pages"/three_hundred/*_[12]?.data "$pages"/three_hundred/*_30.data -o "$pages/many_out"
mkdir "$pages/empty"
PATH=$pages/empty quiet "$bin/flightwatt-report" "$pages/many_out" -o "$pages/many.html" --figures "$pages/many_figures"
rm -rf "$pages/three_hundred" "$pages/three_hundred_out" "$pages/many_out"

PAGES=$pages FLIGHTWATT_WEB=$web CHROMIUM=$chromium node --test --test-reporter=spec "$source/tests/report/page_test.mjs"
