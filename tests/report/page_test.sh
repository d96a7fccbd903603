#!/usr/bin/env bash
# Makes the pages of page_test.mjs and opens them in Chromium: page_test.sh BIN WEB SCRATCH [FLIGHTS]. Without FLIGHTS that
# is a page of six flights; with it also pages of 30 and of FLIGHTS flights and of hostile names, on every
# screen and on paper. Exits with 77 (skipped) where node, its modules or Chromium are missing.
set -euo pipefail
bin=$1
web=$2
pages=$3
flights=${4:-0}
source=$(cd "$(dirname "$0")/../.." && pwd)

skip() {
    echo "skipped: $1 is missing; scripts/install_dependencies build tests installs it" >&2
    exit 77
}
command -v node >/dev/null || skip node
[[ -d $web/node_modules/playwright-core && -d $web/node_modules/preact ]] || skip web/node_modules
chromium=$(command -v chromium || command -v chromium-browser) || skip chromium

rm -rf "$pages"
mkdir -p "$pages/hostile"
quiet() { "$@" >"$pages/stdout" 2>"$pages/stderr" || { cat "$pages/stderr" >&2 && exit 1; }; }

quiet "$bin/flightwatt-batch" "$source/logs" -o "$pages/six"
quiet "$bin/flightwatt-report" "$pages/six" "$source"/missions/paper/*.toml -o "$pages/six.html" --json
mv "$pages/stdout" "$pages/six.json"

quiet "$bin/flightwatt" "$source/logs" --capacity 3.2 -o "$pages/answer"
mv "$pages/stdout" "$pages/answer.txt"

browse() {
    PAGES=$pages FLIGHTS=$flights FLIGHTWATT_WEB=$web CHROMIUM=$chromium \
        node --test --test-reporter=spec "$source/tests/report/page_test.mjs"
}
if ((flights == 0)); then
    browse
    exit
fi

# Names that a page must not accept.
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

# Pages of many flights, whose details are compressed.
many_flights() {
    local count=$1 name=$2
    quiet "$bin/flightwatt-synthesize" "$source/fits/mechanical/opterra-table1.toml" --flights "$count" --seed 3 -o "$pages/logs"
    quiet "$bin/flightwatt-batch" "$pages/logs" -o "$pages/logs_out"
    quiet "$bin/flightwatt-report" "$pages/logs_out" "$source/missions/paper/phased.toml" -o "$pages/$name.html"
    rm -rf "$pages/logs" "$pages/logs_out"
}
many_flights 30 many
many_flights "$flights" more
browse
