"""One core's computing: fits of a phase, schedules by tables, drawn flights; each beside its peer."""

import json
import subprocess

from measure import say
from rows import Row, at_least, at_most, times_as_fast

TARGETS = ["fit_series", "schedules_bench", "sampling_bench"]
SCIPY_PYTHON = "/usr/bin/python3"  # Debian's, which has Debian's SciPy


def have_scipy():
    try:
        return subprocess.run([SCIPY_PYTHON, "-c", "import scipy"], capture_output=True).returncode == 0
    except OSError:
        return False


def numbers_of(text):
    return [[float(word) for word in line.split()] for line in text.splitlines()]


def fit_rows(bench):
    """The slowest of four series of 6000 samples: our fit beside SciPy's and beside one linear solve."""
    say("fits of a phase, beside SciPy")
    asks_scipy = have_scipy()
    ours, scipy = [], []
    for _ in range(bench.sizes.rounds):
        bench.run([bench.benchmark("fit_series"), bench.folder], one_core=True)
        ours.append(numbers_of(bench.printed()))
        if asks_scipy and not scipy:  # takes its own least of three
            command = [SCIPY_PYTHON, bench.source("tests/bench/scipy_fit.py"), bench.folder]
            bench.run(command, one_core=True, variables={"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"})
            scipy = numbers_of(bench.printed())
    fits = [min(run[i][1] for run in ours) for i in range(len(ours[0]))]
    solves = [min(run[i][3] for run in ours) for i in range(len(ours[0]))]
    slowest = max(range(len(fits)), key=fits.__getitem__)
    least_gain = min(range(len(fits)), key=lambda i: scipy[i][1] / fits[i]) if scipy else slowest
    off = max(abs(line[2] / line[0] - 1.0) for line in ours[0])
    of = "6000 samples"
    beside_scipy = scipy[least_gain][1] if scipy else None
    return [
        times_as_fast("fit of a phase", of, fits[least_gain], "SciPy", beside_scipy, at_least(10)),
        times_as_fast("fit of a phase, the slowest", of, fits[slowest], "a linear solve", solves[slowest], at_most(3e-3, "s")),
        Row("its frequency, worst of 4 series", of, 100.0 * off, "%", at_most(1, "%")),
    ]


def schedule_rows(bench):
    """Of the paper's mission, 73 segments each: from cumulative tables, beside classic Runge-Kutta with 43 steps."""
    count = bench.sizes.schedules
    say(f"final charge of {count} schedules, beside Boost.Odeint")
    command = [bench.benchmark("schedules_bench"), f"--benchmark_filter=/schedules:{count}/", "--benchmark_format=json"]
    bench.run(command, one_core=True)
    runs = {run["name"].split("/")[0]: run for run in json.loads(bench.printed())["benchmarks"]}
    seconds = {name: run["cpu_time"] * 1e-3 for name, run in runs.items()}
    tables, slots, odeint = (seconds[f"final_soc_by_{name}"] for name in ("tables", "slots", "odeint"))
    off = max(runs[f"final_soc_by_{name}"]["worst_difference_percent"] for name in ("tables", "slots"))
    of = f"{count} schedules"
    return [
        times_as_fast("final charge by tables", of, tables, "Odeint", odeint, at_least(20)),
        times_as_fast("the same, common slots", of, slots, "Odeint", odeint, at_least(20)),
        Row("their worst difference", "100 schedules", off, "points", at_most(1e-4, "points")),
    ]


def sampling_rows(bench):
    """Flights a second and core, by 32 side by side, beside the same one at a time."""
    say("drawn flights")
    command = [bench.benchmark("sampling_bench"), f"--benchmark_min_time={bench.sizes.least_benchmark_s}", "--benchmark_format=json"]
    most, off, compared = {}, {}, {}
    for _ in range(bench.sizes.rounds):
        bench.run(command, one_core=True)
        for run in json.loads(bench.printed())["benchmarks"]:
            name = "/".join(run["name"].split("/")[:2])
            most[name] = max(most.get(name, 0.0), run.get("items_per_second", 0.0))
            if "worst_difference_percent" in run:
                off[name], compared[name] = run["worst_difference_percent"], run["compared"]
    rows = []
    for battery, title in (("thevenin", "Thévenin pack"), ("paper", "the paper's pack")):
        together, alone = most[f"side_by_side/{battery}"], most[f"one_at_a_time/{battery}"]
        reference = f"off_runge_kutta/{battery}"
        ratio = together / alone
        rows.append(Row("drawn flights a core", title, together, "/s", at_least(1e5, "/s"), "one by one", alone, ratio))
        of = f"{compared[reference]:.0f} flights"
        rows.append(Row(f"off Runge-Kutta, {title}", of, off[reference], "points", at_most(0.01, "points")))
    return rows


def measure(bench):
    return fit_rows(bench) + schedule_rows(bench) + sampling_rows(bench)
