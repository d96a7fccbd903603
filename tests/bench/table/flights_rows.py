"""What many flights cost: one page of them, a batch that finds nothing changed, and leave-one-out."""

import os
import shutil

from measure import make_flights, say
from rows import Row, at_least, at_most, times_as_fast

TARGETS = ["programs"]


def batched(bench, logs, out):
    """A batch, and the same once more."""
    command = [bench.program("batch"), os.path.dirname(logs[0]), "-o", out]
    first = bench.run(command)
    again = min((bench.run(command) for _ in range(bench.sizes.rounds)), key=lambda run: run.cpu_s)
    of = f"{len(logs)} logs"
    return times_as_fast("batch, nothing changed", of, again.cpu_s, "first run", first.cpu_s, at_least(10))


def page_rows(bench, out, flights):
    page = bench.path("flights.html")
    rounds = min(2, bench.sizes.rounds)
    wall_s = min(bench.run([bench.program("report"), out, "-o", page]).wall_s for _ in range(rounds))
    of = f"{flights} flights"
    return [
        Row("a page of flights", of, wall_s, "s", at_most(10, "s")),
        Row("its size", of, os.path.getsize(page) / 1e6, "MB", at_most(15, "MB")),
    ]


def growth(bench, stage, logs):
    """Twice the flights may take a tenth more than twice the time."""
    half = len(logs) // 2
    program = bench.program(stage)
    fewer, all_s = (bench.run([program, *chosen, "-o", bench.path("result")]).cpu_s for chosen in (logs[:half], logs))
    of = f"{len(logs)} flights"
    return Row(f"{stage}, twice the flights", of, all_s, "s", at_most(2.2), f"{half} flights", fewer, all_s / fewer)


def measure(bench):
    sizes = bench.sizes
    say(f"making {sizes.flights} flights")
    logs = make_flights(bench, "flights", max(sizes.flights, 2 * sizes.validated))
    leave_one_out = logs[: 2 * sizes.validated]
    say(f"leave-one-out of {len(leave_one_out)}")
    rows = [growth(bench, stage, leave_one_out) for stage in ("validate", "battery")]
    say(f"batch and page of {len(logs)}")
    out = bench.path("flights.out")
    rows += [batched(bench, logs, out), *page_rows(bench, out, len(logs))]
    shutil.rmtree(out)
    shutil.rmtree(os.path.dirname(logs[0]))
    return rows
