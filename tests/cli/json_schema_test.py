#!/usr/bin/python3
"""The JSON of every stage is as its --json-schema states: json_schema_test.py FOLDER_OF_PROGRAMS.

The commands of tests/cli/golden that print JSON are run, and COMMANDS for stages and options that are in none of them,
with a `flightwatt` that keeps what it prints. Skipped (77) without python3-jsonschema.
"""

import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(sys.argv[1]).resolve()
KEEPING = f"""#!/bin/sh
case " $* " in
  *" --json "*) kept=$(mktemp "$KEPT/$1.XXXXXX"); {PROGRAMS}/flightwatt "$@" > "$kept"; code=$?; cat "$kept"; exit $code ;;
  *) exec {PROGRAMS}/flightwatt "$@" ;;
esac
"""
LOG = '"$SOURCE/logs/opterra_synthetic_01.data"'
LOGS = '"$SOURCE"/logs/opterra_synthetic_0[1-4].data'
COMMANDS = [
    f'flightwatt fit {LOGS} --errors -o m.toml --json; flightwatt predict {LOG} --model m.toml --at 300 --remaining 300 --json'
    ' --battery "$SOURCE/fits/battery/synthetic-3s.toml"',
    f"flightwatt fit {LOGS} --model-kind best -o m.toml --json",
    f"flightwatt validate {LOGS} --at 300 --json",
    f"flightwatt replay {LOGS} --order 1 --json --mission \"$SOURCE/missions/paper/adaptive-replanned.toml\"",
    f"flightwatt export {LOG} --json -o track.kml; flightwatt export {LOG} --json -o columns.csv",
    'flightwatt simulate "$SOURCE/missions/paper/adaptive-replanned.toml" --samples 100 --json',
    'flightwatt compare "$SOURCE"/missions/paper/p*.toml --samples 100 --json',
    'flightwatt plan "$SOURCE/missions/paper/plan.toml" --probability 0.9 --json',
    'flightwatt plan "$SOURCE/missions/paper/phased.toml" --longest-cruise --probability 0.9 --json',
    'flightwatt profile --check-interpolation "$SOURCE/fits/compute/tx2-detection.csv" --json',
    'flightwatt diff "$SOURCE"/missions/paper/phased.toml "$SOURCE"/missions/paper/plan.toml --json',
    f'flightwatt watch - --json --replan --mission "$SOURCE/missions/synthetic/survey-path.toml" < {LOG}',
]


def golden_commands():
    for case in sorted((SOURCE / "tests/cli/golden").glob("*.case")):
        command = case.read_text(encoding="utf-8", errors="replace").split("--- command\n", 1)[1].split("\n--- ", 1)[0]
        if "--json" in command:
            yield command


def run(folder, number, command, kept):
    place = folder / str(number)
    place.mkdir()
    environment = {**os.environ, "SOURCE": str(SOURCE), "KEPT": str(kept), "LC_ALL": "C", "COLUMNS": "80",
                   "PATH": f"{folder / 'bin'}:{PROGRAMS}:{os.environ['PATH']}"}
    subprocess.run(["sh", "-c", command], cwd=place, env=environment, stdin=subprocess.DEVNULL, check=False,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def documents(file):
    text = file.read_text(encoding="utf-8", errors="replace")
    if not text.startswith("{\n"):
        return [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    return [json.loads(text)]


def main():
    listed = subprocess.run([PROGRAMS / "flightwatt", "help"], capture_output=True, text=True, check=True).stdout
    words = {line.split()[0] for line in listed.splitlines() if line.startswith("  ") and line.split()}
    validators = {}
    for stage in sorted(words):
        asked = subprocess.run([PROGRAMS / "flightwatt", stage, "--json-schema"], capture_output=True, text=True, check=False)
        if asked.returncode == 0:
            schema = json.loads(asked.stdout)
            Draft202012Validator.check_schema(schema)
            validators[stage] = Draft202012Validator(schema)
    if len(validators) < 20:
        sys.exit(f"only {sorted(validators)} have a schema")
    errors = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        kept = folder / "kept"
        kept.mkdir()
        (folder / "bin").mkdir()
        (folder / "bin/flightwatt").write_text(KEEPING, encoding="utf-8")
        (folder / "bin/flightwatt").chmod(0o755)
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(lambda job: run(folder, job[0], job[1], kept), enumerate([*golden_commands(), *COMMANDS])))
        counts = dict.fromkeys(validators, 0)
        for file in sorted(kept.iterdir()):
            stage = file.name.rsplit(".", 1)[0]
            for document in documents(file):
                counts[stage] += 1
                if list(document)[:2] != ["format", "stage"] or document["stage"] != stage:
                    errors.append(f"{stage}: begins with {list(document.items())[:2]}")
                for error in validators[stage].iter_errors(document):
                    errors.append(f"{stage}: {error.json_path}: {error.message[:300]}")
                    for inner in error.context or []:
                        errors.append(f"  {inner.json_path}: {inner.message[:200]}")
    errors += [f"{stage}: none of the commands prints its JSON" for stage, count in counts.items() if count == 0]
    print(f"{sum(counts.values())} documents of {len(counts)} stages")
    if errors:
        sys.exit("\n".join(errors[:60]))


main()
