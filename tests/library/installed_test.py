#!/usr/bin/env python3
"""Installs the library, moves the tree, builds examples/ against it, and sets what they print next to the programs: of
live_predictor next to flightwatt watch --json and predict, of the others next to segment, fit, battery and simulate.

usage: installed_test.py SOURCE BUILD FOLDER [LOG.data MODEL.toml BATTERY.toml REMAINING_S]...
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

LINE = re.compile(
    r"([0-9.]+) s  (\S+) Wh so far, (\S+) to (\S+) more"
    r"(?:, lands with (\S+) % at (\S+) V)?(?:, below the reserve: (\S+))?$"
)


def run(command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.returncode}\n{(done.stdout + done.stderr)[-2000:]}")
    return done.stdout


def installed(build, folder):
    """A prefix that was moved after the installation, with no other headers than those of include/."""
    shutil.rmtree(folder, ignore_errors=True)
    run(["cmake", "--install", build, "--component", "library", "--prefix", folder / "first"])
    (folder / "first").rename(folder / "moved")
    for path in (folder / "moved").rglob("*.cmake"):
        for mine in (str(build), str(folder / "first")):
            if mine in path.read_text():
                sys.exit(f"{path} names {mine}")
    headers = {path.name for path in (folder / "moved").rglob("*.h")}
    if headers != {f"{name}.h" for name in ("log", "flight", "model", "battery", "mission", "predictor")}:
        sys.exit(f"installed headers: {sorted(headers)}")
    return folder / "moved"


def built(source, prefix, folder):
    example = folder / "example"
    compiler = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run(["cmake", "-G", "Ninja", "-S", source / "examples", "-B", example, "-DCMAKE_BUILD_TYPE=Release",
         f"-DCMAKE_PREFIX_PATH={prefix}", *compiler])
    run(["cmake", "--build", example])
    return example


def same(a, b):
    return a is None and b is None or (
        a is not None and b is not None and math.isclose(float(a), float(b), rel_tol=1e-12, abs_tol=1e-12))


def numbers_of(state):
    """What the example prints of a state of the watch."""
    prediction = state["prediction"]
    battery = prediction.get("battery")
    landing = battery["at_landing"] if battery else {}
    low_wh, high_wh = prediction["remaining_energy_wh_interval_95"].values()
    chance = (state["battery"] or {}).get("probability_below_reserve")
    return [state["energy_wh"], low_wh, high_wh, landing.get("soc_percent"), landing.get("voltage_v"), chance]


def compare(example, build, log, model, battery, remaining_s):
    """Every line of the example next to the watch's, the last one next to predict's."""
    definitions = Path(log).with_suffix(".log")
    with open(log, "rb") as text:
        printed = run([example, definitions, model, remaining_s, battery], stdin=text).splitlines()
    with open(log, "rb") as text:
        watched = run([build / "bin/flightwatt-watch", "-", "--log", definitions, "--model", model, "--remaining",
                       remaining_s, "--battery", battery, "--json"], stdin=text).splitlines()
    states = [json.loads(line) for line in watched]
    states = [state for state in states if state.get("prediction")]
    lines = [LINE.match(line).groups() for line in printed]
    if len(lines) != len(states) or len(lines) < 100:
        sys.exit(f"{log}: {len(lines)} predictions, {len(states)} of the watch")
    for line, state in zip(lines, states):
        expected = numbers_of(state)
        if not all(map(same, line[1:], expected)):
            sys.exit(f"{log}: {line} is not the watch's {expected} at {state['time_s']} s")
    until_s = states[-1]["prediction"]["until_s"]
    predicted = json.loads(run([build / "bin/flightwatt-predict", log, "--model", model, "--remaining", remaining_s,
                                "--battery", battery, "--at-log-time", until_s, "--json"]))
    interval = predicted["remaining_energy_wh_interval_95"]
    if not all(map(same, lines[-1][2:4], interval.values())):
        sys.exit(f"{log}: {lines[-1]} is not what predict states at {until_s} s: {interval}")
    print(f"{Path(log).name}: {len(lines)} predictions as watch and predict state them")


def compare_phases(examples, program, log):
    """Energies of read_log next to those of segment."""
    printed = re.findall(r"^  (takeoff|cruise|landing) (\S+) s (\S+) Wh (\S+) W", run([examples / "read_log", log]), re.M)
    segmented = json.loads(run([program, "segment", log, "--json"]))["flights"][0]["sorties"]
    expected = [(phase["phase"], phase["duration_s"], phase["energy_wh"], phase["mean_power_w"])
                for sortie in segmented for phase in sortie["phases"]]
    if [line[0] for line in printed] != [phase[0] for phase in expected] or len(expected) != 3:
        sys.exit(f"read_log has {printed}, segment {expected}")
    for line, phase in zip(printed, expected):
        if not all(map(same, line[1:], phase[1:])):
            sys.exit(f"read_log has {line}, segment {phase}")


def compare_names(examples, program, model, folder):
    """The second flight of a log is its #2, as in segment and batch."""
    run([program, "synthesize", model, "-o", folder / "sorties", "--anomaly", "two-sorties"])
    log = next((folder / "sorties").glob("*.data"))
    names = re.findall(r"^  (\S+): \S+ Wh in", run([examples / "read_log", log]), re.M)
    if names != [log.stem, f"{log.stem}#2"]:
        sys.exit(f"the flights of {log.name} are named {names}")


def compare_files(examples, program, logs, folder):
    """What fit_model and identify_pack write next to the files of fit and battery."""
    run([examples / "fit_model", folder / "m.toml", *logs])
    run([program, "fit", *logs, "--name", "fitted", "-o", folder / "fit.toml"])
    run([examples / "identify_pack", folder / "p.toml", "1.3", *logs])
    run([program, "battery", *logs, "--capacity", "1.3", "--name", "identified", "-o", folder / "battery.toml"])
    for own, theirs in (("m.toml", "fit.toml"), ("p.toml", "battery.toml")):
        own_lines, lines = ([line for line in (folder / name).read_text().splitlines() if not line.startswith("#")]
                            for name in (own, theirs))
        if own_lines != lines:
            sys.exit(f"{own} and {theirs} differ: {[pair for pair in zip(own_lines, lines) if pair[0] != pair[1]][:3]}")


def compare_mission(examples, program, mission):
    """The landing of simulate_mission next to simulate's."""
    left, energy_wh = re.search(r": (\S+) % left after \S+ s and (\S+) Wh", run([examples / "simulate_mission", mission])).groups()
    expected = json.loads(run([program, "simulate", mission, "--json"]))
    if not same(left, expected["final_soc_percent"]) or not same(energy_wh, expected["energy_wh"]):
        sys.exit(f"simulate_mission has {left} % and {energy_wh} Wh, simulate {expected}")


def main():
    source, build, folder = (Path(word) for word in sys.argv[1:4])
    os.environ.setdefault("LC_ALL", "C.UTF-8")
    examples = built(source, installed(build, folder), folder)
    program = build / "bin/flightwatt"
    logs = sorted((source / "logs").glob("*.data"))
    compare_phases(examples, program, logs[0])
    compare_names(examples, program, source / "fits/mechanical/synthetic-wing.toml", folder)
    compare_files(examples, program, logs, folder)
    compare_mission(examples, program, source / "missions/paper/adaptive.toml")
    waiting = run([examples / "mavlink_predictor", source / "missions/synthetic/survey-path.toml", os.devnull])
    if not waiting.startswith("waits for"):
        sys.exit(f"mavlink_predictor without a byte: {waiting}")
    for i in range(4, len(sys.argv), 4):
        compare(examples / "live_predictor", build, *sys.argv[i:i + 4])


if __name__ == "__main__":
    main()
