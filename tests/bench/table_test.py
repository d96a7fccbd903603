#!/usr/bin/env python3
"""Holds scripts/bench to a whole table: table_test.py BUILD. Its rows are those of docs/performance.md, each with its
numbers and a verdict that these bear out. What the numbers are is not asked: the inputs are small, the machine any.
Exits with 77 (skipped) where the report cannot be drawn."""

import os
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests/bench/table"))
import rows  # noqa: E402

BENCH = os.path.join(ROOT, "scripts/bench")
HEADS = ["what", "of", "ours", "compared with", "ratio", "goal", "is"]
QUANTITY = re.compile(r"(\d+(?:\.\d+)?(?:e[-+]\d+)?)(?: ([a-zA-Zµ%/]+))?")
SCALES = {"µs": 1e-6, "ms": 1e-3, "k/s": 1e3, "M/s": 1e6}


def cells_of(text):
    """The cells of the lines of Markdown tables, without heads and rules."""
    lines = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| ")]
    return [line for line in lines if len(line) == len(HEADS) and line != HEADS]


def value_of(text):
    """Of "6.1 ms" 0.0061."""
    found = QUANTITY.fullmatch(text)
    if not found:
        raise AssertionError(f"'{text}' is no quantity")
    return float(found[1]) * SCALES.get(found[2], 1.0)


def run(*arguments):
    return subprocess.run([BENCH, *arguments], capture_output=True, text=True)


class WholeTable(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.done = run("--quick", "--build", sys.argv[1])
        cls.rows = cells_of(cls.done.stdout)

    def test_has_the_rows_of_the_document(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        with open(os.path.join(ROOT, "docs/performance.md"), encoding="utf-8") as file:
            documented = [row[0] for row in cells_of(file.read())]
        self.assertGreater(len(documented), 20)
        self.assertEqual([row[0] for row in self.rows], documented)

    def test_every_row_has_its_numbers(self):
        for what, of, ours, beside, ratio, goal, verdict in self.rows:
            with self.subTest(what):
                self.assertTrue(of)
                self.assertGreaterEqual(value_of(ours), 0.0)
                self.assertIn(verdict, ("met", "NOT met", "no peer"))
                self.assertEqual(verdict == "no peer", beside.startswith("absent") and ratio == "-")
                if beside != "-" and verdict != "no peer":
                    self.assertGreater(value_of(beside.split(": ", 1)[0]), 0.0)

    def test_verdicts_are_of_the_numbers(self):
        for what, _, ours, _, ratio, goal, verdict in self.rows:
            if verdict == "no peer":
                continue
            relation, wanted = goal.split(" ", 1)
            is_of_ratio = " " not in wanted
            measured, limit = value_of(ratio if is_of_ratio else ours), value_of(wanted)
            if abs(measured - limit) <= 0.01 * limit:  # rounded too far to tell
                continue
            with self.subTest(what):
                met = measured >= limit if relation == ">=" else measured <= limit
                self.assertEqual(verdict, "met" if met else "NOT met")

    def test_says_how_many_are_met(self):
        verdicts = [row[-1] for row in self.rows]
        met, not_met = verdicts.count("met"), verdicts.count("NOT met")
        self.assertIn(f"\n{len(self.rows)} rows: {met} met, {not_met} NOT met", self.done.stdout)


class Rows(unittest.TestCase):
    def test_quantities_have_a_unit_that_suits_them(self):
        measured = ((0.0061, "s"), (4.04e-4, "s"), (1.52e6, "/s"), (253.4, "MB"), (0, "s"))
        written = [rows.quantity(*pair) for pair in measured]
        self.assertEqual(written, ["6.1 ms", "404 µs", "1.52 M/s", "253 MB", "0 s"])
        self.assertEqual(rows.quantity(9.49e-12, "%"), "9.5e-12 %")
        self.assertEqual(rows.quantity(100_000, "files"), "100000 files")

    def test_goals_are_of_the_ratio_or_of_our_own_value(self):
        twice = rows.times_as_fast("a", "b", 2.0, "peer", 4.0, rows.at_least(2))
        self.assertEqual((twice.ratio, twice.verdict()), (2.0, "met"))
        self.assertEqual(rows.times_as_fast("a", "b", 2.0, "peer", 3.9, rows.at_least(2)).verdict(), "NOT met")
        self.assertEqual(rows.times_as_fast("a", "b", 2.0, "peer", 4.0, rows.at_most(1.9, "s")).verdict(), "NOT met")

    def test_an_absent_peer_is_said(self):
        row = rows.times_as_fast("a", "b", 2.0, "peer", None, rows.at_least(2))
        self.assertEqual(row.cells()[3:], ["absent: peer", "-", ">= 2", "no peer"])


class Refusals(unittest.TestCase):
    def refused(self, code, message, *arguments):
        done = run(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(message, done.stderr)
        self.assertEqual(done.stdout, "")

    def test_say_what_is_wrong(self):
        self.refused(2, "unknown part 'reader'; there are log, model", "reader")
        self.refused(2, "'0': expected a whole number", "--rounds", "0")
        self.refused(3, "absent.data: is no log", "--log", "absent.data")
        self.refused(3, "absent: holds no programs", "--quick", "--build", "absent")
        readme = os.path.join(ROOT, "README.md")
        self.refused(3, "does not begin with a time", "--quick", "--build", sys.argv[1], "--log", readme, "log")


if not os.path.isdir(os.path.join(ROOT, "web/node_modules/vega")):
    print("skipped: web/node_modules is missing; scripts/install_dependencies build installs it", file=sys.stderr)
    sys.exit(77)
unittest.main(argv=sys.argv[:1])
