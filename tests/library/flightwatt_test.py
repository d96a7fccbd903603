"""Tests python/flightwatt.py and the examples of docs/python.md: flightwatt_test.py PROGRAM PROJECT. Exit code 77: no pandas."""

import contextlib
import importlib.util
import io
import os
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

if importlib.util.find_spec("pandas") is None:
    print("skipped: python3-pandas is not installed")
    sys.exit(77)
import pandas  # noqa: E402

PROGRAM, PROJECT = map(os.path.abspath, sys.argv[1:3])
os.environ["FLIGHTWATT"] = PROGRAM
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(PROJECT, "python"))
import flightwatt as fw  # noqa: E402

SAMPLE = os.path.join(PROJECT, "logs", "opterra_synthetic_01.data")
SECOND = os.path.join(PROJECT, "logs", "opterra_synthetic_02.data")
MISSION = os.path.join(PROJECT, "missions", "paper", "phased.toml")


class Summaries(unittest.TestCase):
    def test_every_stage_of_the_program_is_a_function(self):
        listed = re.findall(r"^([a-z-]+)\t", subprocess.check_output([PROGRAM, "--list-stages"], text=True), re.MULTILINE)
        self.assertEqual(sorted(name.replace("-", "_") for name in listed), sorted(fw.STAGES))
        for stage in fw.STAGES:
            self.assertTrue(callable(getattr(fw, stage)), stage)

    def test_a_fit_is_a_dict(self):
        model = fw.fit(SAMPLE, SECOND, weights="uniform")
        self.assertEqual(model["weighting"], "uniform")
        self.assertEqual(len(model["flights"]), 2)

    def test_options_become_those_of_the_command_line(self):
        line = fw.command("new_mission", 1, planned=True, quiet=False, name=None, profile=["a.csv", "b.csv"])
        self.assertEqual(line[1:], ["new-mission", "1", "--planned", "--profile", "a.csv", "--profile", "b.csv"])


class Tables(unittest.TestCase):
    def test_a_series_has_a_column_for_each_track(self):
        series = fw.series(SAMPLE)
        self.assertTrue({"time_s", "power_w", "altitude_m"} <= set(series.columns))
        self.assertGreater(series.power_w.count(), 500)

    def test_phases_are_those_of_segment(self):
        phases = fw.phases(SAMPLE)
        self.assertEqual(phases.phase.tolist(), ["takeoff", "cruise", "landing"])
        self.assertAlmostEqual(phases.energy_wh.sum(), 5.017, places=3)

    def test_a_mission_ends_where_its_summary_states(self):
        curve = fw.curve(MISSION)
        self.assertAlmostEqual(curve.soc_percent.iloc[-1], fw.simulate(MISSION)["final_soc_percent"], places=6)

    def test_a_stage_that_prints_text_is_no_table(self):
        with self.assertRaisesRegex(ValueError, "compare prints no CSV here: read the file of output="):
            fw.table("compare", MISSION, quiet=True)

    def test_a_batch_is_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            fw.batch(SAMPLE, SECOND, output=folder)
            self.assertEqual(len(fw.flights(folder)), 6)
            series = pandas.read_csv(f"{folder}/flights/opterra_synthetic_01.series.csv", comment="#")
            pandas.testing.assert_frame_equal(series, fw.series(SAMPLE))

    def test_the_examples_of_the_page_run(self):
        with open(os.path.join(PROJECT, "docs", "python.md"), encoding="utf-8") as page:
            examples = re.findall(r"^```python\n(.*?)^```", page.read(), re.MULTILINE | re.DOTALL)
        self.assertEqual(len(examples), 2)
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            os.symlink(os.path.join(PROJECT, "logs"), "logs")
            results = {}
            with contextlib.redirect_stdout(io.StringIO()):
                exec("\n".join(examples), results)
        self.assertAlmostEqual(results["landing"]["final_soc_percent"], results["curve"].soc_percent.iloc[-1])


class Failures(unittest.TestCase):
    def test_a_missing_log_is_an_error_with_its_exit_code(self):
        with self.assertRaises(fw.FlightWattError) as caught:
            fw.fit("missing.data")
        self.assertEqual(caught.exception.exit_code, 3)
        self.assertIn("No such file", caught.exception.messages)

    def test_a_bad_log_among_good_ones_is_a_warning(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            model = fw.fit(SAMPLE, SECOND, "missing.data")
        self.assertEqual(len(model["flights"]), 2)
        self.assertEqual([one.category for one in caught], [fw.SkippedInput])

    def test_an_unknown_option_is_a_usage_error(self):
        with self.assertRaises(fw.FlightWattError) as caught:
            fw.simulate(MISSION, no_such_option=1)
        self.assertEqual(caught.exception.exit_code, 2)


class Watching(unittest.TestCase):
    def test_predictions_come_one_by_one_until_the_caller_stops(self):
        model = os.path.join(PROJECT, "fits", "mechanical", "synthetic-wing.toml")
        predictions = fw.watch(follow=SAMPLE, model=model, remaining=100)
        phases = {prediction["phase"] for prediction, _ in zip(predictions, range(200))}
        self.assertEqual(phases, {"ground", "takeoff", "cruise"})
        predictions.close()

    def test_a_source_that_is_not_there_is_an_error(self):
        with self.assertRaises(fw.FlightWattError):
            list(fw.watch(follow="missing.data"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
