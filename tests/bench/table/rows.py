"""Rows of the table: what was measured, what it is held against, and whether that is reached."""

import dataclasses

UNITS = {"s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")), "/s": ((1e6, "M/s"), (1e3, "k/s"), (1.0, "/s"))}


def quantity(value, unit):
    """Two or three digits and a unit that suits them: "6.1 ms"."""
    if unit == "files":
        return f"{value:.0f} {unit}"
    scale, name = next((pair for pair in UNITS.get(unit, ((1.0, unit),)) if abs(value) >= pair[0]), (1.0, unit))
    scaled = value / scale
    if abs(scaled) >= 100:
        return f"{scaled:.0f} {name}"
    return f"{scaled:.3g} {name}" if abs(scaled) >= 0.1 else f"{scaled:.2g} {name}"


@dataclasses.dataclass(frozen=True)
class Goal:
    """Without a unit of the ratio, else of our own value."""

    relation: str  # ">=" or "<="
    value: float
    unit: str = ""

    def is_met(self, measured):
        return measured >= self.value if self.relation == ">=" else measured <= self.value

    def __str__(self):
        return f"{self.relation} {quantity(self.value, self.unit) if self.unit else format(self.value, 'g')}"


def at_least(value, unit=""):
    return Goal(">=", value, unit)


def at_most(value, unit=""):
    return Goal("<=", value, unit)


@dataclasses.dataclass(frozen=True)
class Row:
    what: str
    of: str  # the input
    ours: float
    unit: str
    goal: Goal
    beside: str = ""  # the peer or the floor; empty: there is none
    other: float = None  # its value, in the same unit; None: it is absent
    ratio: float = None  # what a goal without a unit is of

    def judged(self):
        return self.ours if self.goal.unit else self.ratio

    def verdict(self):
        if self.judged() is None:
            return "no peer"
        return "met" if self.goal.is_met(self.judged()) else "NOT met"

    def cells(self):
        other = "absent" if self.other is None else quantity(self.other, self.unit)
        beside = f"{other}: {self.beside}" if self.beside else "-"
        ratio = "-" if self.ratio is None else f"{self.ratio:.3g}"
        return [self.what, self.of, quantity(self.ours, self.unit), beside, ratio, str(self.goal), self.verdict()]


def times_as_fast(what, of, ours_s, beside, other_s, goal):
    """Of two times; the ratio says how often ours fits into the other."""
    return Row(what, of, ours_s, "s", goal, beside, other_s, other_s / ours_s if other_s is not None else None)


def table(rows):
    """In Markdown, so that documents take it as it is."""
    cells = [["what", "of", "ours", "compared with", "ratio", "goal", "is"]] + [row.cells() for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(len(cells[0]))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(line, widths)) + " |" for line in cells]
    rule = "|" + "|".join("-" * (width + 2) for width in widths) + "|"
    return "\n".join([lines[0], rule, *lines[1:]])
