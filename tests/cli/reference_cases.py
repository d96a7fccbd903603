"""The commands whose outputs scripts/reference keeps. A case is a name and a script for sh; it runs in a folder of its
own with $SOURCE (the project) and $SHARED (real logs; cases that need it are left out without), next to a link to the
latter as ../shared. What it prints and what it writes into its folder is kept."""

import os
import random
import re

READABLE = (".data", ".LOG", ".bin", ".csv")


def golden_cases(source):
    folder = os.path.join(source, "tests/cli/golden")
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), encoding="utf-8", errors="surrogateescape") as file:
            text = file.read()
        command = text.split("--- command\n", 1)[1].split("\n--- exit", 1)[0]
        if name == "merge_rejected.case":
            command += "\nrm -r out"  # which flights are written before another is rejected is left to chance
        yield "golden/" + name.removesuffix(".case"), command


def document_cases(source):
    """The commands whose output a document shows, in its order."""
    for name in ("README.md", "CONTRIBUTING.md", "docs/exports.md", "docs/guide.md", "docs/live.md",
                 "docs/tutorial.md", "docs/validation.md"):
        with open(os.path.join(source, name), encoding="utf-8") as file:
            shown = re.findall(r"<!-- output of(?: \(needs ../shared\))?: ([^\n]+?) -->", file.read())
        links = 'for file in "$SOURCE"/*; do [ "${file##*/}" = out ] || ln -s "$file" .; done; mkdir out'
        commands = [f"echo '$' {quoted(command)}\n({command})\necho \"exit $?\"" for command in shown]
        yield "document/" + os.path.basename(name), "\n".join([links, *commands])


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def log_cases(source, shared):
    folders = {"logs": (source, "logs")}
    if shared:
        for name in ("flights", "archives/no-power", "archives/rovers", "archives/binary", "archives/autopilots/ardupilot",
                     "archives/autopilots/px4"):
            folders[name] = (shared, name)
    known = ('--model "$SOURCE/fits/mechanical/synthetic-wing.toml" --remaining 300 '
             '--battery "$SOURCE/fits/battery/synthetic-3s.toml" --initial-soc 90')
    for name, (root, folder) in folders.items():
        variable = "$SOURCE" if root == source else "$SHARED"
        for file in sorted(os.listdir(os.path.join(root, folder))):
            if not file.endswith(READABLE):
                continue
            log = f'"{variable}/{folder}/{file}"'
            definitions = f'"{variable}/{folder}/{os.path.splitext(file)[0]}.log"'
            has_definitions = os.path.exists(os.path.join(root, folder, os.path.splitext(file)[0] + ".log"))
            script = [
                f"flightwatt parse {log} -o parsed.csv",
                f"flightwatt segment {log} --explain",
                f"flightwatt segment {log} --json",
                f"flightwatt path {log}",
                f"flightwatt predict {log} --at 240 {known} --json",
            ]
            if file.endswith(".data"):
                with_log = f"--log {definitions}" if has_definitions else ""
                script.append(f"flightwatt watch - {with_log} --json {known} < {log}")
            yield f"log/{name}/{file}", "\n".join(script)


def batch_cases(source, shared):
    folders = {"logs": "$SOURCE/logs"}
    if shared:
        folders |= {"flights": "$SHARED/flights", "archives": "$SHARED/archives", "m100": "$SHARED/m100"}
    for name, folder in folders.items():
        yield f"batch/{name}", f"""
            flightwatt batch "{folder}" -o out --model-kind physical --published "$SOURCE/fits/mechanical/opterra-table1.toml" --json
            flights=$(ls out/flights/*.series.csv)
            flightwatt fit $flights --json -o fit.toml --table fit.csv --curves curves.csv
            flightwatt battery $flights --capacity 3.2 --json -o battery.toml
            flightwatt battery $flights
            flightwatt validate $flights --json
            flightwatt trends out --json -o trends.csv
            for format in c px4 inav paparazzi latex; do flightwatt export out/model.toml --format $format; done
            for format in gpx geojson csv; do flightwatt export $flights --format $format; done
            flightwatt replay $flights --mission "$SOURCE/missions/paper/adaptive-replanned.toml" --json
            flightwatt report out --json -o page.html
            flightwatt report out "$SOURCE"/missions/paper/[aip]*.toml --replay --figures figures -o with-missions.html"""


def mission_cases(source):
    for folder in ("paper", "synthetic"):
        for name in sorted(os.listdir(os.path.join(source, "missions", folder))):
            if name.endswith(".toml"):
                mission = f'"$SOURCE/missions/{folder}/{name}"'
                disturbed = " ".join(
                    f'; flightwatt simulate {mission} --json --disturb "$SOURCE/missions/disturbances/{disturbance}.toml"'
                    for disturbance in ("headwind", "sudden-drop", "weak-pack"))
                yield f"mission/{folder}/{name}", questions(mission, 50) + disturbed.replace("; ", "\n")
    yield "mission/compare", ('flightwatt compare "$SOURCE"/missions/paper/*.toml -o compared.csv\n'
                              'flightwatt compare "$SOURCE"/missions/paper/*.toml --json --samples 100\n'
                              'flightwatt compare "$SOURCE"/missions/paper/p*.toml --json '
                              '--disturb "$SOURCE/missions/disturbances/headwind.toml"')
    for seed in range(1, 37):
        yield f"generated/{seed:02}", f"cat > mission.toml <<END\n{generated_mission(seed)}END\n" + questions("mission.toml", 50)


def questions(mission, samples):
    return "\n".join([
        f"flightwatt plan {mission} --json -o planned.toml || cp {mission} planned.toml",
        "flightwatt simulate planned.toml -o simulated.csv",
        f"flightwatt simulate planned.toml --json --samples {samples} --seed 7",
        f"flightwatt plan {mission} --json --probability 0.9",
        f"flightwatt plan {mission} --longest-cruise --json",
        f"flightwatt plan {mission} --spare-power --json",
    ])


def generated_mission(seed):
    """A mission to be planned, with a battery and spreads that the seed draws; every third has a schedule instead."""
    draw = random.Random(seed)
    thevenin = draw.random() < 0.5
    lines = ['mechanical = "$SOURCE/fits/mechanical/opterra-table1.toml"', f'name = "generated-{seed}"',
             f"duration_s = {{ cruise = {draw.randint(900, 1500)} }}",
             f"initial_soc_percent = {draw.uniform(80, 100):.2f}",
             f"reserve_soc_percent = {draw.uniform(0, 25):.2f}"]
    if thevenin:
        lines.append('battery = "$SOURCE/fits/battery/synthetic-3s.toml"')
        lines.append(f"cutoff_voltage_v = {draw.choice([0, 9.9, 10.5])}")
        lines.append(f"capacity_ah = {draw.uniform(1.9, 2.9):.3f}")
    else:
        lines.append(f"battery = {{ voltage_v = {draw.uniform(10, 12):.3f}, resistance_ohm = {draw.uniform(0, 0.1):.4f}, "
                     f"capacity_ah = {draw.uniform(1.9, 2.9):.3f} }}")
    lines.append(f"uncertainty.level_sd_percent = {{ takeoff = {draw.randint(1, 9)}, cruise = {draw.randint(1, 9)}, "
                 f"landing = {draw.randint(1, 9)} }}")
    shape = draw.choice(["linear", "sqrt", "log"])
    lines += ["[components.detection]", 'profile = "$SOURCE/fits/compute/tx2-detection.csv"',
              f'utility = {{ parameter = "fps", shape = "{shape}" }}']
    if seed % 3 == 0:
        lines += ["[[schedule]]", 'phase = "cruise"', f'middle = "{draw.randint(5, 95)} %"',
                  "run = { detection = { fps = 32 } }", "[[schedule]]", "otherwise = true",
                  f"run = {{ detection = {{ fps = {draw.uniform(6, 20):.2f} }} }}"]
    else:
        lines += ["[plan]", f"slot_s = {draw.choice([20, 60, 120])}"]
    if seed % 4 == 1 and seed % 3:
        lines += ["[policy]", 'kind = "adaptive"', f"mechanical_sd_percent = {draw.randint(2, 8)}"]
    return "\n".join(lines) + "\n"


def all_cases(source, shared):
    yield from batch_cases(source, shared)  # the longest first
    yield from mission_cases(source)
    yield from document_cases(source)
    yield from log_cases(source, shared)
    yield from golden_cases(source)
