#!/usr/bin/env bash
# Renders every figure of a report without a browser: figures_test.sh BIN WEB SCRATCH. Exits with 77 (skipped) where
# node, its modules or rsvg-convert are missing.
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
[[ -d $web/node_modules/vega ]] || skip web/node_modules
command -v rsvg-convert >/dev/null || skip rsvg-convert

rm -rf "$scratch"
mkdir -p "$scratch"
"$bin/flightwatt-batch" "$source"/logs/*.data -o "$scratch/out" >/dev/null 2>&1
printed=$("$bin/flightwatt-report" "$scratch/out" "$source"/missions/paper/*.toml --figures "$scratch/figures" 2>&1)
echo "$printed"
[[ $printed == *": .vl.json, .svg, .pdf" ]]

# Every SVG parses, has marks and an axis with its unit; every PDF is one.
python3 - "$scratch/figures" <<'PYTHON'
import glob, os, sys
import xml.etree.ElementTree as xml

specs = sorted(glob.glob(os.path.join(sys.argv[1], "*.vl.json")))
assert len(specs) >= 10, specs
for spec in specs:
    svg = xml.parse(spec.replace(".vl.json", ".svg")).getroot()
    paths = [path for path in svg.iter("{http://www.w3.org/2000/svg}path") if len(path.get("d", "")) > 8]
    texts = "".join(text.text or "" for text in svg.iter("{http://www.w3.org/2000/svg}text"))
    assert len(paths) >= 3, spec
    assert any(unit in texts for unit in ("[W]", "[m]", "[%]", "[Wh]", "[V]")), (spec, texts[:200])
    with open(spec.replace(".vl.json", ".pdf"), "rb") as pdf:
        assert pdf.read(5) == b"%PDF-", spec
print(f"{len(specs)} figures")
PYTHON

# In one column and in two, figures are landscape, with type of 8 points, 10.67 pixels; no text is clipped or over another,
# no tick without its label, and long times are in minutes.
for width in 3.5 7; do
    "$bin/flightwatt-report" "$scratch/out" "$source"/missions/paper/{phased,plan,adaptive,invariant-5.8fps-32bit,mechanical-only}.toml --figures "$scratch/column" --figure-width "${width}in" --figure-font serif 2>/dev/null
    python3 "$(dirname "$0")/figure_texts.py" "$(python3 -c "print(96 * $width)")" "$scratch"/column/*.svg
    python3 - "$scratch/column" <<'PYTHON'
import glob, os, re, sys

drawings = sorted(glob.glob(os.path.join(sys.argv[1], "*.svg")))
assert len(drawings) >= 8, drawings
assert os.path.join(sys.argv[1], "flight-opterra_synthetic_01-power.svg") in drawings
for drawing in drawings:
    svg = open(drawing, encoding="utf-8").read()
    assert "Serif" in svg and "DejaVu Sans" not in svg, drawing
    sizes = {float(size) for size in re.findall(r'font-size="([\d.]+)px"', svg)}
    assert sizes and all(abs(size - 32 / 3) < 0.01 for size in sizes), (drawing, sizes)
    if "-power" in drawing or "schedules" in drawing:
        assert "[min]" in svg and "[s]" not in svg, drawing
PYTHON
done

# None is taller than is asked for.
"$bin/flightwatt-report" "$source/missions/paper/phased.toml" --figures "$scratch/low" --figure-width 7in --figure-height 3in 2>/dev/null
for drawing in "$scratch"/low/*.svg; do
    tall=$(grep -o '<svg[^>]* height="[0-9]*' "$drawing" | grep -o '[0-9]*$')
    ((tall <= 288)) || { echo "$drawing: $tall px" >&2 && exit 1; }
done

# Without node none is made, and it is printed.
tools=$scratch/tools
mkdir "$tools"
printed=$(PATH=$tools "$bin/flightwatt-report" "$source/missions/paper/phased.toml" --figures "$scratch/without" 2>&1)
[[ $printed == *"node is not there: no figure was made" ]]
[[ ! -e $scratch/without/schedules-soc.vl.json ]]
