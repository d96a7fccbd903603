"""Missions as a user runs them: sampled flights, a report's page, looks of a flight in the air, plans in flight."""

import re

from measure import BenchError, say
from rows import Row, at_most, times_as_fast

TARGETS = ["programs", "live_day_bench"]
THEVENIN = "missions/synthetic/thevenin-pack.toml"
PAPER = "missions/paper/phased.toml"
SURVEY = "missions/synthetic/survey-path.toml"


def simulated(bench):
    """What a thousand flights add: at 100,000 a second and core 10 ms of the processor, at 40,000 25 ms."""
    say("simulate, with samples and without")
    rows = []
    for title, mission, goal_s in (("Thévenin pack", THEVENIN, 0.025), ("paper's pack", PAPER, 0.01)):
        plain = [bench.program("simulate"), bench.source(mission), "-o", bench.path("soc.csv")]
        sampled = plain + ["--samples", "1000"]
        commands = {"plain": (plain, False), "sampled": (sampled, False)}
        runs = bench.least(commands, 4 * bench.sizes.rounds)  # short ones differ more
        ours_s, without_s = runs["sampled"].cpu_s, runs["plain"].cpu_s
        added_s = max(0.0, ours_s - without_s)
        rows.append(Row("simulate, 1000 samples add", title, added_s, "s", at_most(goal_s, "s"), "all else", without_s))
    return rows


def reported(bench):
    """The whole command: the page's own work is in it, as a mission alone makes a page."""
    say("report of a mission")
    page = [bench.program("report"), bench.source(THEVENIN), "-o", bench.path("mission.html")]
    wall_s = bench.least({"page": (page, False)})["page"].wall_s
    return Row("report of a mission", "Thévenin pack", wall_s, "s", at_most(1, "s"))


def looks(bench, hours, every_s, *options):
    """Mean and most [s] of the looks that predict, over made-up telemetry."""
    command = [bench.benchmark("live_day_bench"), bench.source(SURVEY), str(hours), str(every_s), *options]
    bench.run(command, one_core=True)
    line = re.compile(r"^looks with a prediction +(\d+), mean ([\d.]+), .*most ([\d.]+) ms$", re.MULTILINE)
    found = line.search(bench.printed())
    if not found:
        raise BenchError("live_day_bench says nothing of looks with a prediction")
    return int(found[1]), float(found[2]) * 1e-3, float(found[3]) * 1e-3


def watched(bench):
    hours = bench.sizes.live_hours
    say(f"{hours:g} h of telemetry")
    count, mean_s, most_s = looks(bench, hours, 10)
    of = f"{count} updates"
    # Plans come with a slot's first look: one of many, which a third of an hour in the air has enough of.
    decided, _, planned_s = looks(bench, max(0.85, hours / 12), 10, "--replan")
    return [
        Row("mean update of watch", of, mean_s, "s", at_most(5e-2, "s")),
        Row("longest update of watch", of, most_s, "s", at_most(5e-2, "s")),
        Row("longest update that plans", f"{decided} updates", planned_s, "s", at_most(0.2, "s")),
    ]


def measure(bench):
    return [*simulated(bench), reported(bench), *watched(bench)]
