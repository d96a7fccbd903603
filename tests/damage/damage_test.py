#!/usr/bin/env python3
"""Damages logs as real ones are damaged, and tests every program that reads logs on them.

    damage_test [COUNT] [--binary] [--undamaged] [--only NAME] [--seed N] [--programs FOLDER] [--keep FOLDER] [LOG...]

With --binary they are written as the SD card of an aircraft writes them, and also damaged as its bytes are: by the
definitions of their own .log and, where it is, of ../shared/pprzlink, with these as a capture of a link too. COUNT
executions (10,000 by default) over the logs of logs/, those of hazards/ of the build and, where it is,
../shared/flights, or over those that are named. Of every execution: an allowed exit code, no finding of a sanitizer, no
hang, no more than 1 GB, no NaN in a result, and an energy that is within 5 % of the undamaged log's or is warned of.
Programs are those of build/sanitize/bin unless --programs names others. What fails goes to --keep, with its command; the exit code
is then 1. The same seed (1 by default) damages the same logs in the same way.

`start`, `restart` and `follow` are `watch` from a random line on: by its standard input, with a clock that is set back
in flight, and as it follows a binary log. 2,000 starts over real logs as they are:

    damage_test 2000 --undamaged --only start ../shared/flights/20_*.data
"""

import argparse
import collections
import concurrent.futures
import csv
import glob
import io
import math
import os
import random
import re
import shlex
import shutil
import signal
import sys
import tempfile
import threading

sys.dont_write_bytecode = True
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests/helpers"))
import binary_damage  # noqa: E402
import binary_frames  # noqa: E402
import power_damage  # noqa: E402
import text_damage  # noqa: E402
from execution import Execution  # noqa: E402

MOST_MEMORY_KB = 1_000_000
ENERGY_TOLERANCE = 0.05
TEXT_DAMAGES = text_damage.DAMAGES + power_damage.DAMAGES
ALLOWED_EXITS = (0, 3, 4)
COPIES = ("play", "convert")
MODEL = os.path.join(ROOT, "fits/mechanical/synthetic-wing.toml")
BATTERY = os.path.join(ROOT, "fits/battery/synthetic-3s.toml")
PPRZLINK = os.path.join(ROOT, "../shared/pprzlink/messages.xml")
IN_FLIGHT = ("start", "restart", "follow")
WATCHED_LINES = 3000
WATCHED_BYTES = 100_000
RESTARTS_S = (65.0, 100.0, 200.0, 340.0, 600.0)
SANITIZED = re.compile(rb"Sanitizer|runtime error:|Assertion .* failed|internal error")
NOT_A_NUMBER = re.compile(rb"(?<![A-Za-z_])[-+]?(?:nan|inf)(?![A-Za-z_])", re.IGNORECASE)


def sorties_of(output):
    """Start, end and energy [Wh] of every sortie in a phases CSV whose energy is known."""
    rows = csv.DictReader(io.StringIO(output.decode("utf-8", "replace")))
    sorties = {}
    for row in rows:
        if row.get("energy_wh"):
            start_s, _, energy = sorties.get(row["sortie"], (float(row["start_s"]), 0.0, 0.0))
            sorties[row["sortie"]] = (start_s, float(row["end_s"]), energy + float(row["energy_wh"]))
    return list(sorties.values())


def energy_wh(sorties):
    return sum(energy for _, _, energy in sorties) if sorties else None


def time_of(line):
    """Minus infinity without one."""
    try:
        return float(line.split(b" ", 1)[0])
    except ValueError:
        return float("-inf")


def first_time(lines):
    return next(filter(math.isfinite, map(time_of, lines)), 0.0)


def time_range(log):
    """The first and the last time of a log: what is known of sorties outside of it cannot be asked for."""
    return first_time(log.lines), first_time(reversed(log.lines))


def begun_in_flight(name, chance, log):
    """The log as `start`, `restart` and `follow` get it, which begin at a random line, or a random byte."""
    if name == "follow":
        data = b"".join(log.frames)
        first = chance.randrange(len(data) + 1)
        return text_damage.Log([], log.definitions, [data[first : first + WATCHED_BYTES]])
    last = chance.randrange(len(log.lines) + 1)
    if name == "start":
        return text_damage.Log(log.lines[last : last + WATCHED_LINES], log.definitions)
    again_s = first_time(reversed(log.lines[:last])) - chance.choice(RESTARTS_S)
    again = next((i for i, line in enumerate(log.lines) if time_of(line) >= again_s), 0)
    lines = log.lines[max(0, last - WATCHED_LINES // 2) : last] + log.lines[again : again + WATCHED_LINES // 2]
    return text_damage.Log(lines, log.definitions)


def commands_of(programs, log, folder, is_binary):
    """What is done with a log, by name. Every command writes to its standard output or into `folder`."""

    def run(program, *arguments):
        return [os.path.join(programs, "flightwatt-" + program), *arguments]

    definitions = os.path.splitext(log)[0] + ".log"
    known = ("--log", definitions) if os.path.exists(definitions) else ()
    rest = ("--model", MODEL, "--remaining", "100", "--battery", BATTERY, "--initial-soc", "90", *known)
    if is_binary:
        watches = {"follow": run("watch", "--follow", log, "--json", *rest)}
    else:
        watches = {"start": run("watch", "-", *rest), "restart": run("watch", "-", *rest)}
    return {
        **watches,
        "segment": run("segment", log),
        "parse": run("parse", log),
        "explain": run("segment", log, "--explain"),
        "fit": run("fit", log, "--order", "1"),
        "validate": run("validate", log, OTHER_LOG),
        "predict": run("predict", log, "--model", MODEL, "--until", "100", "--remaining", "100"),
        "battery": run("battery", log, "--json"),
        "batch": run("batch", os.path.dirname(log), "-o", os.path.join(folder, "out"), "--jobs", "2"),
        "path": run("path", "--path-from", log),
        "play": run("play", log, "--to", "-", "--speed", "100000"),
        "convert": run("convert", log),  # of a text log it states that there is nothing to convert
    }


OTHER_LOG = os.path.join(ROOT, "logs/opterra_synthetic_02.data")


def write_log(log, folder):
    path = os.path.join(folder, "logs", "flight.data" if log.frames is None else "flight.LOG")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(b"".join(log.lines if log.frames is None else log.frames))
    configuration = os.path.splitext(path)[0] + ".log"
    if log.definitions is None:
        if os.path.exists(configuration):
            os.remove(configuration)
    else:
        with open(configuration, "w", encoding="latin-1", newline="") as file:
            file.write(log.definitions)
    return path


def read_log(path):
    with open(path, "rb") as file:
        lines = file.read().splitlines(keepends=True)
    configuration = path.removesuffix("data") + "log"
    if not os.path.exists(configuration):
        return text_damage.Log(lines, None)
    with open(configuration, encoding="latin-1", newline="") as file:
        return text_damage.Log(lines, file.read())


def as_binary(log, version):
    """The log as a card holds it; None where none of its messages is defined."""
    frames = binary_frames.frames_of(log.lines, log.definitions or "", version)
    return text_damage.Log(log.lines, log.definitions, frames) if any(frames) else None


def as_by_pprzlink(log):
    """The log as an aircraft with the definitions of PPRZLINK sends it."""
    with open(PPRZLINK, encoding="latin-1", newline="") as file:
        protocol = re.search("<protocol.*</protocol>", file.read(), re.DOTALL).group()
    definitions = re.sub("<protocol.*</protocol>", lambda _: protocol, log.definitions, flags=re.DOTALL)
    return text_damage.Log(list(binary_frames.lines_as_defined(log.lines, log.definitions, protocol)), definitions)


def read_originals(options, most):
    """Logs by name, no more than are damaged."""
    originals = {}
    for path in options.logs:
        if len(originals) >= most:
            break
        log = read_log(path)
        if not options.binary:
            originals[path] = log
        elif as_binary(log, 2):
            originals[path] = log
            if os.path.exists(PPRZLINK):
                originals[path + " by pprzlink"] = as_by_pprzlink(log)
    return originals


def damaged(original, seed, is_binary):
    """A copy with one damage or two, and their names. Of a binary one half are of its bytes, half of what it holds."""
    chance = random.Random(seed)
    log = text_damage.Log(list(original.lines), original.definitions)
    of_bytes = is_binary and chance.random() < 0.5
    kinds = chance.sample(binary_damage.DAMAGES if of_bytes else TEXT_DAMAGES, 2 if chance.random() < 0.2 else 1)
    if of_bytes:
        log = as_binary(log, chance.choice((1, 2)))
    for kind in kinds:
        kind(chance, log)
        if not log.lines or (of_bytes and not any(log.frames)):
            break
    if is_binary and not of_bytes:
        # The definitions may be damaged, those that the aircraft was built with were not.
        changed = log.definitions if "definitions" not in "".join(kind.__name__ for kind in kinds) else None
        framing = chance.choice(("card", "link")) if '"TIMESTAMP"' in original.definitions else "card"
        frames = binary_frames.frames_of(log.lines, changed or original.definitions, chance.choice((1, 2)), framing)
        log = text_damage.Log(log.lines, log.definitions, frames)
    return log, "+".join(kind.__name__ for kind in kinds)


def silent_energy_error(execution, reference, damage, log, folder):
    """How far the energy is from that of the undamaged log, if nothing was printed about it; empty if all is well."""
    sorties = reference["sorties"]
    if damage.removeprefix("frames_") in ("cut_off", "begun_late"):
        begin_s, end_s = time_range(log)
        sorties = [sortie for sortie in sorties if sortie[1] > begin_s and sortie[0] < end_s]
    before, now = energy_wh(sorties), energy_wh(sorties_of(execution.output))
    if not before or execution.warnings(folder) - reference["warnings"]:
        return ""
    if now is not None and abs(now - before) <= ENERGY_TOLERANCE * before:
        return ""
    return f"silent energy error: {'none' if now is None else f'{now:.4f}'} for {before:.4f} Wh"


def faults_of(name, execution, folder):
    """What one execution did that none may do. Copies of a log may hold what the log holds."""
    faults = []
    if execution.code < 0:
        faults.append(f"killed by {signal.Signals(-execution.code).name}")
    elif execution.code not in ALLOWED_EXITS:
        faults.append(f"exit code {execution.code}")
    if SANITIZED.search(execution.messages):
        faults.append("sanitizer or internal error")
    if execution.memory_kb > MOST_MEMORY_KB:
        faults.append(f"{execution.memory_kb / 1000:.0f} MB")
    result = b"" if name in COPIES else execution.output
    for path in glob.glob(os.path.join(folder, "out/**/*.csv"), recursive=True):
        with open(path, "rb") as file:
            result += file.read()
    if NOT_A_NUMBER.search(result):
        faults.append("NaN in the result")
    return faults


class Run:
    def __init__(self, options):
        self.options = options
        self.lock = threading.Lock()
        self.executions = collections.Counter()
        self.exits = collections.Counter()
        self.accepted = collections.Counter()
        self.failures = []
        self.slowest_s = 0.0
        self.memory_kb = 0

    def commands(self, log, folder):
        return commands_of(self.options.programs, log, folder, self.options.binary)

    def damaged(self, original, seed):
        if not self.options.undamaged:
            return damaged(original, seed, self.options.binary)
        return as_binary(original, 2) if self.options.binary else original, "undamaged"

    def reference_of(self, original):
        """What `segment` states of the undamaged log."""
        with tempfile.TemporaryDirectory() as folder:
            log = write_log(as_binary(original, 2) if self.options.binary else original, folder)
            execution = Execution(self.commands(log, folder)["segment"], log, folder)
            sorties = sorties_of(execution.output) if execution.code == 0 else []
            return {"sorties": sorties, "warnings": execution.warnings(folder)}

    def one_log(self, seed, path, original, reference, names):
        with tempfile.TemporaryDirectory() as folder:
            log, damage = self.damaged(original, seed)
            whole = write_log(log, folder)
            for name in names:
                shutil.rmtree(os.path.join(folder, "out"), ignore_errors=True)
                given = whole
                if name in IN_FLIGHT:
                    begun = begun_in_flight(name, random.Random(f"{seed} {name}"), log)
                    given = write_log(begun, os.path.join(folder, name))
                execution = Execution(self.commands(given, folder)[name], given, folder)
                faults = faults_of(name, execution, folder)
                if name == "segment" and execution.code == 0:
                    error = silent_energy_error(execution, reference, damage, log, folder)
                    faults += [error] if error else []
                with self.lock:
                    self.executions[name] += 1
                    self.exits[execution.code] += 1
                    self.accepted[name] += execution.code == 0
                    self.slowest_s = max(self.slowest_s, execution.processor_s)
                    self.memory_kb = max(self.memory_kb, execution.memory_kb)
                if faults:
                    self.report(seed, path, damage, name, faults, execution, folder)

    def report(self, seed, path, damage, name, faults, execution, folder):
        line = f"seed {seed}: {os.path.basename(path)}, {damage}: {name}: {'; '.join(faults)}"
        with self.lock:
            self.failures.append(line)
            print(f"damage_test: {line}", file=sys.stderr)
        if self.options.keep:
            kept = os.path.join(self.options.keep, f"{seed}_{name}")
            shutil.copytree(folder, kept, dirs_exist_ok=True)
            with open(os.path.join(kept, "command"), "w", encoding="utf-8") as file:
                file.write(f"{shlex.join(execution.command)} < {execution.input}\n".replace(folder, kept))


def read_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("count", nargs="?", type=int, default=10_000)
    parser.add_argument("logs", nargs="*")
    parser.add_argument("--binary", action="store_true")
    parser.add_argument("--undamaged", action="store_true", help="each log as it is")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--programs", default=os.path.join(ROOT, "build/sanitize/bin"))
    parser.add_argument("--keep")
    parser.add_argument("--only", help="one program: segment, parse, ..., or start, restart, follow")
    options = parser.parse_intermixed_args()
    names = list(commands_of("", "", "", options.binary))
    if options.only and options.only not in names:
        parser.error(f"--only {options.only}: expected one of {', '.join(names)}")
    options.names = [options.only] if options.only else names
    if not os.path.exists(os.path.join(options.programs, "flightwatt-segment")):
        parser.error(f"no programs in {options.programs}: build them with scripts/build sanitize")
    if not options.logs:
        hazards = os.path.join(options.programs, "../hazards")
        for folder in ("logs", hazards, "../shared/flights"):
            options.logs += sorted(glob.glob(os.path.join(ROOT, folder, "*.data")))
    return options


def main():
    options = read_options()
    os.environ.setdefault("ASAN_OPTIONS", "hard_rss_limit_mb=1500:quarantine_size_mb=64")
    run = Run(options)
    names = options.names
    rounds = (options.count + len(names) - 1) // len(names)
    if options.binary and not os.path.exists(PPRZLINK):
        print(f"damage_test: no {os.path.relpath(PPRZLINK)}: SKIPPED its definitions", file=sys.stderr)
    originals = read_originals(options, rounds)
    paths = list(originals)
    references = {path: run.reference_of(log) for path, log in originals.items()}
    flights = sum(bool(reference["sorties"]) for reference in references.values())
    if flights == 0:
        print(f"damage_test: error: none of {len(paths)} logs holds a flight with its energy", file=sys.stderr)
        return 1
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as workers:
        jobs = []
        for i in range(rounds):
            path = paths[i % len(paths)]
            these = names[: min(len(names), options.count - i * len(names))]
            seed = options.seed * 1_000_000 + i
            jobs.append(workers.submit(run.one_log, seed, path, originals[path], references[path], these))
        for done, job in enumerate(concurrent.futures.as_completed(jobs)):
            job.result()
            if done % 100 == 99 and sys.stderr.isatty():
                print(f"damage_test: {sum(run.executions.values())} of {options.count}", file=sys.stderr)
    kind = ("undamaged" if options.undamaged else "damaged") + (" binary" if options.binary else "")
    print(f"{sum(run.executions.values())} executions on {rounds} {kind} logs of {len(paths)}, seed {options.seed}")
    print(f"of the {len(paths)}, {flights} hold a flight with its energy")
    print("exit codes: " + ", ".join(f"{code}: {count}" for code, count in sorted(run.exits.items())))
    print("never exit code 0: " + (", ".join(name for name in names if not run.accepted[name]) or "none"))
    print(f"slowest: {run.slowest_s:.1f} s of processor time; most memory: {run.memory_kb / 1000:.0f} MB")
    print(f"failures: {len(run.failures)}")
    return 1 if run.failures else 0


if __name__ == "__main__":
    sys.exit(main())
