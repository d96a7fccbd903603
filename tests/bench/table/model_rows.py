"""One core's computing: fits of a phase, drawn flights; each beside its peer."""

import json
import os
import subprocess
import sys

from measure import say
from rows import Row, at_least, at_most, times_as_fast

TARGETS = ["fit_series", "sampling_bench"]


def python_with_scipy():
    """This Python, or else Debian's, which has Debian's SciPy; None where neither has it."""
    for python in (sys.executable, "/usr/bin/python3"):
        asked = [python, "-c", "import scipy"]
        if os.path.exists(python) and subprocess.run(asked, capture_output=True).returncode == 0:
            return python
    return None


def scipy_fits(bench):
    """Seconds of each of the series that fit_series wrote, the least of three; None where SciPy is absent."""
    python = python_with_scipy()
    if python is None:
        return None
    command = [python, bench.source("tests/bench/scipy_fit.py"), bench.folder]
    bench.run(command, one_core=True, variables={"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
    return [line[1] for line in numbers_of(bench.printed())]


def numbers_of(text):
    return [[float(word) for word in line.split()] for line in text.splitlines()]


def fit_rows(bench):
    """Four series of 6000 samples: where we gain least beside SciPy, and the slowest beside one linear solve."""
    say("fits of a phase, beside SciPy")
    runs = []
    for _ in range(bench.sizes.rounds):
        bench.run([bench.benchmark("fit_series"), bench.folder], one_core=True)
        runs.append(numbers_of(bench.printed()))
    scipy = scipy_fits(bench)
    series = range(len(runs[0]))
    fits, solves = ([min(run[i][column] for run in runs) for i in series] for column in (1, 3))
    slowest = max(series, key=fits.__getitem__)
    closest = min(series, key=lambda i: scipy[i] / fits[i]) if scipy else slowest
    off_percent = 100.0 * max(abs(line[2] / line[0] - 1.0) for line in runs[0])
    of = "6000 samples"
    return [
        times_as_fast("fit of a phase", of, fits[closest], "SciPy", scipy and scipy[closest], at_least(5)),
        times_as_fast("fit, the slowest series", of, fits[slowest], "one solve", solves[slowest], at_most(3e-2, "s")),
        Row("frequency of a fit, off by", of, off_percent, "%", at_most(1, "%")),
    ]


def sampling_rows(bench):
    """Flights a second and core."""
    say("drawn flights")
    least_s = f"--benchmark_min_time={bench.sizes.least_benchmark_s}"
    command = [bench.benchmark("sampling_bench"), least_s, "--benchmark_format=json"]
    most, off = {}, {}
    for _ in range(bench.sizes.rounds):
        bench.run(command, one_core=True)
        for run in json.loads(bench.printed())["benchmarks"]:
            name = "/".join(run["name"].split("/")[:2])
            most[name] = max(most.get(name, 0.0), run.get("items_per_second", 0.0))
            if "worst_difference_percent" in run:
                off[name] = run["worst_difference_percent"]
    rows = []
    for battery, title, goal in (("thevenin", "Thévenin pack", 4e4), ("paper", "paper's pack", 1e5)):
        rows.append(Row("drawn flights a core", title, most[f"drawn_flights/{battery}"], "/s", at_least(goal, "/s")))
        worst = off[f"off_runge_kutta/{battery}"]
        rows.append(Row("drawn flights, off by", title, worst, "%", at_most(0.01, "%")))
    return rows


def measure(bench):
    return fit_rows(bench) + sampling_rows(bench)
