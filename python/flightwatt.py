"""FlightWatt from Python: each stage is a function; its result is a dict or a pandas.DataFrame.

    import flightwatt as fw
    fw.batch("logs", output="out")               # flightwatt batch logs --output out --json
    flights = fw.flights("out")                  # out/flights.csv: one row per flight and phase
    soc = fw.curve("mission.toml")               # state of charge over time, from flightwatt simulate

Inputs of a stage are arguments. Options are keywords with _ instead of -: True gives an option without a value, a list
repeats the option, None and False omit it. The program is FLIGHTWATT of the environment, or the one that pip installed
with this module, or flightwatt on the PATH. Tables need pandas; the rest needs the standard library only.
"""

import functools
import importlib.metadata
import io
import json
import os
import subprocess
import tempfile
import warnings

STAGES = (
    "answer init parse convert segment fit validate predict watch diff trends battery batch merge profile new_mission simulate "
    "check compare plan replay path play report export synthesize"
).split()
SKIPPED_INPUT = 3  # exit code: some inputs were skipped (with a result), or no input was usable (without one)


class FlightWattError(RuntimeError):
    """A stage ended without a result. `exit_code`: 2 usage, 3 input rejected, 4 no usable result,
    5 a mission misses what `require` demands. `messages`: its text."""

    def __init__(self, command_line, exit_code, messages):
        super().__init__(f"{' '.join(command_line)}: exit code {exit_code}\n{messages}")
        self.exit_code = exit_code
        self.messages = messages


class SkippedInput(UserWarning):
    """Some inputs were unusable; the result is that of the others."""


@functools.lru_cache(maxsize=None)
def _installed_program():
    """The program of the wheel that this module came with, wherever pip has put it; else flightwatt on the PATH."""
    try:
        files = importlib.metadata.files("flightwatt") or ()
    except importlib.metadata.PackageNotFoundError:
        files = ()
    programs = [file.locate() for file in files if file.parts[-2:] == ("bin", "flightwatt")]
    return str(programs[0]) if programs else "flightwatt"


def command(stage, *inputs, **options):
    """The command line of a stage, as a list."""
    line = [os.environ.get("FLIGHTWATT") or _installed_program(), stage.replace("_", "-"), *map(str, inputs)]
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is True:
                line.append(option)
            elif one is not None and one is not False:
                line += [option, str(one)]
    return line


def run(stage, *inputs, **options):
    """Runs a stage and returns its standard output. Raises FlightWattError; warns SkippedInput."""
    line = command(stage, *inputs, **options)
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    if done.returncode == SKIPPED_INPUT and done.stdout:
        warnings.warn(done.stderr, SkippedInput, stacklevel=3)
    elif done.returncode != 0:
        raise FlightWattError(line, done.returncode, done.stderr)
    return done.stdout


def _summary_of(stage):
    def summary(*inputs, **options):
        return json.loads(run(stage, *inputs, json=True, **options))

    summary.__name__ = summary.__qualname__ = stage
    summary.__doc__ = f"The summary of `flightwatt {stage.replace('_', '-')} --json`, as a dict (a list of several inputs)."
    return summary


for _stage in STAGES:
    globals()[_stage] = _summary_of(_stage)


def watch(**options):
    """Yields the predictions of `flightwatt watch --json`, one dict each, until the source ends or the caller stops."""
    line = command("watch", json=True, **options)
    with tempfile.TemporaryFile("w+") as messages:
        with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=messages, text=True) as process:
            try:
                for text in process.stdout:
                    yield json.loads(text)
            finally:
                if process.poll() is None:
                    process.terminate()
        if process.returncode > 0:
            messages.seek(0)
            raise FlightWattError(line, process.returncode, messages.read())


def _table(text):
    import pandas

    rows = io.StringIO(text)
    start = 0
    while rows.readline().startswith("#"):  # the header of a series
        start = rows.tell()
    rows.seek(start)
    return pandas.read_csv(rows)


def table(stage, *inputs, **options):
    """The CSV that a stage writes to its standard output, as a DataFrame. ValueError: it prints something else."""
    text = run(stage, *inputs, **options)
    header = next((line for line in text.splitlines() if not line.startswith("#")), "")
    if "," not in header:
        raise ValueError(f"flightwatt {stage} prints no CSV here: read the file of output=\"FILE.csv\" with pandas.read_csv")
    return _table(text)


def series(log, **options):
    """The tracks of a flight over time_s, from flightwatt parse: one column per quantity, NaN between its samples."""
    return table("parse", log, **options)


def phases(*logs, **options):
    """Take-off, cruise and landing of each sortie, from flightwatt segment."""
    return table("segment", *logs, **options)


def curve(mission, **options):
    """Power and state of charge of a mission over time_s, from flightwatt simulate."""
    return table("simulate", mission, **options)


def flights(folder):
    """The catalogue of a folder of flightwatt batch: one row per flight and phase."""
    with open(os.path.join(folder, "flights.csv"), encoding="utf-8") as file:
        return _table(file.read())
