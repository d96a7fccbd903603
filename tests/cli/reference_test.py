#!/usr/bin/env python3
"""Holds scripts/reference to what it is for: reference_test.py BIN. Two runs are equal, and what is changed is found."""

import base64
import importlib.machinery
import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
REFERENCE = os.path.join(ROOT, "scripts/reference")
PROGRAMS = sys.argv.pop(1)

loader = importlib.machinery.SourceFileLoader("reference", REFERENCE)
reference = importlib.util.module_from_spec(importlib.util.spec_from_loader("reference", loader))
loader.exec_module(reference)


def run(*arguments):
    return subprocess.run([REFERENCE, *arguments, "--only", "generated/03"], capture_output=True, text=True, check=False)


class Reference(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "made")
        made = run("make", self.folder, "--programs", PROGRAMS)
        self.assertEqual(made.returncode, 0, made.stderr)

    def change(self, pattern, replacement):
        """Replaces the first match in what the case printed."""
        path = os.path.join(self.folder, "generated/03/stdout")
        with open(path, encoding="utf-8") as file:
            old = file.read()
        new = re.sub(pattern, replacement, old, count=1)
        self.assertNotEqual(old, new)
        with open(path, "w", encoding="utf-8") as file:
            file.write(new)

    def compare(self, *arguments):
        return run("compare", self.folder, "--programs", PROGRAMS, *arguments)

    def test_finds_nothing_where_nothing_changed(self):
        compared = self.compare()
        self.assertEqual(compared.returncode, 0, compared.stdout)
        self.assertRegex(compared.stdout, r" [1-9]\d* files compared, 0 differ\n$")

    def test_finds_a_number_that_changed_by_a_billionth(self):
        self.change(r'("energy_wh": )([\d.]+)', lambda found: found[1] + repr(float(found[2]) * (1.0 + 1e-9)))
        compared = self.compare()
        self.assertEqual(compared.returncode, 1)
        self.assertRegex(compared.stdout, r"generated/03/stdout: 1 numbers differ, most by 1e-09 of it in line \d+: ")
        self.assertEqual(self.compare("--tolerance", "1e-8").returncode, 0)

    def test_finds_a_key_that_changed_unless_it_was_renamed(self):
        self.change(r'"energy_wh"', '"older_energy_wh"')
        self.assertIn('stdout: text differs in line', self.compare().stdout)
        names = self.folder + ".names"
        with open(names, "w", encoding="utf-8") as file:
            file.write("# old and new\nolder_energy_wh energy_wh\n")
        compared = self.compare("--renamed", names)
        self.assertEqual(compared.returncode, 0, compared.stdout)

    def test_finds_a_file_that_is_missing(self):
        os.remove(os.path.join(self.folder, "generated/03/files/simulated.csv"))
        self.assertIn("generated/03/files/simulated.csv: is new", self.compare().stdout)


class Texts(unittest.TestCase):
    def test_page_data_are_compared_unpacked(self):
        block = base64.b64encode(zlib.compress(b"<p>12.5 Wh</p>")).decode()
        page = f'<script type="text/plain" class="block">{block}</script>'
        self.assertIn("<p>12.5 Wh</p>", reference.unpacked(page))

    def test_numbers_are_not_parts_of_words(self):
        self.assertEqual(reference.NUMBER.findall("a0 1.5,-2e-3 v0.2.0 20_07.data (3) 5"), ["1.5", "-2e-3", "3", "5"])

    def test_times_are_masked(self):
        self.assertEqual(reference.masked("at 2026-11-24T10:11:12Z in /x/y", [("/x", "X")]), "at TIME in X/y")


unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
