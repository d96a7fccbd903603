#!/usr/bin/env python3
"""Texts of figures for papers: figure_texts.py WIDTH FILE.svg...

Exits with 1 if a text is beyond the figure's edge or over another one, or if a tick has lost its label."""
import re
import sys
import xml.etree.ElementTree as xml

SVG = "{http://www.w3.org/2000/svg}"
LETTER = 0.5  # width of a letter [type sizes], at least; boxes may overlap a little where letters do not


def boxes(element, left, top, found):
    """Adds (text, left, top, right, bottom) of each line of text below an element."""
    turned = False
    for name, numbers in re.findall(r"(translate|rotate)\(([^)]*)\)", element.get("transform", "")):
        values = [float(value) for value in numbers.split(",")]
        if name == "translate":
            left, top = left + values[0], top + values[1]
        turned = turned or (name == "rotate" and values[0] == -90)
    if element.tag == SVG + "text":
        size = float(element.get("font-size").removesuffix("px"))
        spans = list(element) or [element]
        for row, span in enumerate(spans):
            wide = LETTER * size * len(span.text or "")
            begin = {"end": -wide, "middle": -wide / 2}.get(element.get("text-anchor"), 0.0)
            line = (begin, row * 1.1 * size - 0.75 * size, begin + wide, row * 1.1 * size)
            if turned:
                line = (line[1], -line[2], line[3], -line[0])
            found.append((span.text or "", left + line[0], top + line[1], left + line[2], top + line[3], element.get("opacity")))
    for child in element:
        boxes(child, left, top, found)


def faults(file, width):
    """The faults of a figure, as texts."""
    root = xml.parse(file).getroot()
    found = []
    boxes(root, 0.0, 0.0, found)
    wide, tall = (float(root.get(side)) for side in ("width", "height"))
    if wide > width + 0.5:
        yield f"{wide} px wide"
    if tall > wide:
        yield f"not landscape: {wide} by {tall} px"
    shown = [box for box in found if box[0].strip() and box[5] != "0"]
    for text, *_ in (box for box in found if box[5] == "0" and box[0].strip()):
        yield f"a tick without its label, '{text}'"
    for i, (text, left, top, right, bottom, _) in enumerate(shown):
        if left < -1 or top < -1 or right > wide + 1 or bottom > tall + 1:
            yield f"'{text}' is beyond the edge"
        for other, left2, top2, right2, bottom2, _ in shown[i + 1 :]:
            if min(right, right2) - max(left, left2) > 1 and min(bottom, bottom2) - max(top, top2) > 1 and text != other:
                yield f"'{text}' is over '{other}'"


failed = False
for name in sys.argv[2:]:
    for fault in faults(name, float(sys.argv[1])):
        failed = True
        print(f"{name}: {fault}")
sys.exit(failed)
