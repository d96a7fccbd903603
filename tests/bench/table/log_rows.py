"""One large log: our reader beside grep, memchr and Python, and `flightwatt parse` beside grep."""

import json
import os
import re
import shutil

from measure import BenchError, say
from rows import Row, at_least, at_most, times_as_fast

TARGETS = ["read_log", "reader_bench", "programs"]
# Python splits; it parses no numbers.
PYTHON = "import sys\nwith open(sys.argv[1], 'rb') as f:\n    for line in f: line.split()"


def write_log(bench):
    """The sample again and again, its clock going on, up to the size; path, and its size as text."""
    with open(bench.sample, "rb") as file:
        lines = file.read().splitlines(keepends=True)
    try:
        rows = [(float(line.split(b" ", 1)[0]), line.split(b" ", 1)[1]) for line in lines]
    except (ValueError, IndexError):
        wanted = "expected a Paparazzi .data file"
        raise BenchError(f"{bench.sample}: has a line that does not begin with a time; {wanted}", 3) from None
    span_s = rows[-1][0] - rows[0][0] + 1.0
    path = bench.path("flight.data")
    with open(path, "wb") as log:
        for number in range(-(-bench.sizes.log_mb * 1_000_000 // sum(map(len, lines)))):
            log.write(b"".join(b"%.3f %s" % (time_s + number * span_s, rest) for time_s, rest in rows))
    messages = bench.sample.removesuffix(".data") + ".log"
    if os.path.exists(messages):
        shutil.copy(messages, bench.path("flight.log"))
    return path, f"{os.path.getsize(path) / 1e6:.0f} MB"


def rows_of(of, runs):
    cpu_s = {name: run.cpu_s for name, run in runs.items()}

    def row(what, ours, beside, other, goal):
        return times_as_fast(what, of, cpu_s[ours], beside, cpu_s[other], at_least(goal))

    return [
        row("energy messages of a log", "energy", "grep -F -c", "grep", 0.15),
        row("energy messages, against lines", "energy", "memchr", "lines", 0.1),
        row("every line into words", "words", "Python", "python", 2),
        row("words, fields as numbers", "numbers", "Python", "python", 1.5),
        row("flightwatt parse", "parse", "grep -F -c", "grep", 0.02),
    ]


def memory_of_reader(bench, log, of):
    bench.run([bench.benchmark("read_log"), "memory", log])
    beyond_kb = int(re.search(r"beyond_file_kb (\d+)", bench.printed())[1])
    return Row("memory beyond the log's pages", of, beyond_kb * 1024 / 1e6, "MB", at_most(350, "MB"))


def binary_beside_text(bench):
    """In messages a second; the messages of the sample as an SD card stores them, and the same as text."""
    say("messages of a card and of its text")
    least_s = f"--benchmark_min_time={bench.sizes.least_benchmark_s}"
    command = [bench.benchmark("reader_bench"), "--benchmark_filter=_of_", least_s, "--benchmark_format=json"]
    most = {}
    for _ in range(bench.sizes.rounds):
        # It reads text with its .log beside it, which a named sample may not have.
        bench.run(command, one_core=True, variables={"FLIGHTWATT_BENCH_LOG": ""})
        for run in json.loads(bench.printed())["benchmarks"]:
            most[run["name"]] = max(most.get(run["name"], 0.0), run.get("items_per_second", 0.0))
    card, text = most["energy_messages_of_a_card"], most["energy_messages_of_its_text"]
    return Row("messages of a binary log", "450k messages", card, "/s", at_least(1), "its text", text, card / text)


def measure(bench):
    say(f"writing a log of {bench.sizes.log_mb} MB")
    log, of = write_log(bench)
    series = bench.path("series.csv")
    read_log = bench.benchmark("read_log")
    commands = {
        "grep": (["grep", "-F", "-c", " ENERGY ", log], True),
        "python": (["python3", "-c", PYTHON, log], True),
        "lines": ([read_log, "lines", log], True),
        "energy": ([read_log, "energy", log], True),
        "words": ([read_log, "words", log], True),
        "numbers": ([read_log, "numbers", log], True),
        "parse": ([bench.program("parse"), log, "-o", series], True),
    }
    say("reading it, beside grep, memchr and Python")
    runs = bench.least(commands)
    rows = [*rows_of(of, runs), memory_of_reader(bench, log, of)]
    for path in (log, series):
        os.remove(path)
    return [*rows, binary_beside_text(bench)]
