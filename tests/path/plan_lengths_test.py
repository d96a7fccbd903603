#!/usr/bin/env python3
"""Lengths and times of plans as a wing flies them, by another computation than the program's, within 1 %.

usage: plan_lengths_test.py BIN

Places are on a sphere, ways with turns the shortest by the tangents of their circles (docs/methods.md, Turns). Plans of
../shared are skipped, visibly, where that folder is absent.
"""
import cmath, json, math, subprocess, sys, tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
SPEED = 13.0
R = SPEED**2 / 9.80665  # a bank of 45 degrees


def arc(start, end, side):
    """The angle from one direction to another in a turn (side 1: counter-clockwise)."""
    angle = (side * (end - start)) % (2 * math.pi)
    return 0.0 if angle > 2 * math.pi - 1e-7 else angle


def shortest(place, course, to, to_course):
    """The shortest way between poses; courses are counter-clockwise from the real axis."""
    lengths = []
    for s in (1, -1):
        for e in (1, -1):
            a = place + 1j * s * R * cmath.exp(1j * course)
            b = to + 1j * e * R * cmath.exp(1j * to_course)
            way, apart = cmath.phase(b - a), abs(b - a)
            if s == e:
                lengths.append(R * (arc(course, way, s) + arc(way, to_course, s)) + apart)
                if 0 < apart < 4 * R:
                    lean = math.acos(apart / (4 * R))
                    for sign in (1, -1):
                        middle = a + 2 * R * cmath.exp(1j * (way + sign * lean))
                        on, off = (cmath.phase(middle - c) + s * math.pi / 2 for c in (a, b))
                        lengths.append(R * (arc(course, on, s) + arc(on, off, -s) + arc(off, to_course, s)))
            elif apart >= 2 * R:
                line = way + s * math.asin(2 * R / apart)
                lengths.append(R * (arc(course, line, s) + arc(line, to_course, e)) + math.sqrt(apart**2 - 4 * R**2))
    return min(lengths)


def flown(places):
    places = [p for i, p in enumerate(places) if i == 0 or abs(p - places[i - 1]) > 1e-6]
    legs = [b - a for a, b in zip(places, places[1:])]
    course = [cmath.phase(leg) for leg in legs]
    turn = [abs(math.remainder(b - a, 2 * math.pi)) for a, b in zip(course, course[1:])]
    bent = lambda i: 0 <= i < len(turn) and math.degrees(turn[i]) > 0.1
    half = lambda i: abs(legs[i]) * (0.5 if bent(i - 1) and bent(i) else 1.0)
    cut = [0.0] * (len(legs) + 1)
    for i in range(len(turn)):
        need = R * math.tan(turn[i] / 2) if turn[i] < 3 else math.inf
        if bent(i) and turn[i] <= math.radians(120) and need <= min(half(i), half(i + 1)):
            cut[i] = need
    place, now, total = places[0], course[0], 0.0
    for i, leg in enumerate(legs):
        target, then = places[i + 1] - cut[i] * cmath.exp(1j * course[i]), course[i]
        if abs(math.remainder(now - course[i], 2 * math.pi)) > 2e-3 and abs(leg) < 2 * R and bent(i) and not cut[i]:
            target, then = places[i + 1], course[i + 1]
        total += shortest(place, now, target, then) if abs(target - place) > 1e-6 else 0.0
        place, now = target, then
        if cut[i]:
            total += R * turn[i]
            place, now = places[i + 1] + cut[i] * cmath.exp(1j * course[i + 1]), course[i + 1]
    return total


def on_plane(places):
    latitude = math.radians(places[0][0])
    return [complex((b - places[0][1]) * math.cos(latitude), a - places[0][0]) * math.radians(1) * 6371008.8
            for a, b in places]


def plan_places(file):
    """Latitudes and longitudes of the waypoints of a plan, in order."""
    if file.suffix == ".waypoints":
        rows = [line.split() for line in file.read_text().splitlines()[1:] if line.split()]
        items = [(int(row[3]), float(row[8]), float(row[9])) for row in rows]
        items[0] = (0, *items[0][1:])
    else:
        mission = json.loads(file.read_text())["mission"]
        items = [(0, *mission["plannedHomePosition"][:2])]
        for item in mission["items"]:
            for one in item.get("TransectStyleComplexItem", {}).get("Items", [item]):
                items.append((one["command"], *(x or 0.0 for x in one["params"][4:6])))
    home, places = items[0][1:], []
    takes_off = any(command == 22 for command, *_ in items)
    for command, *place in items:
        if command == 20 or (command == 0 and not takes_off) or (command == 22 and place == [0.0, 0.0]):
            places.append(home)
        elif command in (16, 21, 22) and place != [0.0, 0.0]:
            places.append(tuple(place))
    return places


def measured(programs, folder, plan):
    fits = PROJECT / "fits"
    mission = folder / "m.toml"
    made = subprocess.run(
        [f"{programs}/flightwatt", "new-mission", "--force", "--model", fits / "mechanical/synthetic-wing.toml",
         "--battery", fits / "battery/synthetic-3s.toml", "--plan", plan, "--airspeed", str(SPEED), "-o", mission],
        capture_output=True, text=True)
    assert made.returncode == 0, made.stderr
    path = subprocess.run([f"{programs}/flightwatt", "path", mission, "--json"], capture_output=True, text=True)
    return json.loads(path.stdout)


def made_up(folder):
    """Squares, and surveys over fields by lines of different spacing, as CSV in metres."""
    for side in (30, 100, 800):
        yield f"square {side}", [0, side * 1j, side + side * 1j, side]
    for spacing in (10, 30, 60):
        places = []
        for line in range(9):
            ends = [spacing * line, spacing * line + (350 + 20 * line) * 1j]
            places += ends if line % 2 == 0 else ends[::-1]
        yield f"survey {spacing}", places
    yield "zigzag", [0, 300 + 80j, 0 + 160j, 300 + 170j, 290 + 400j, 280 + 170j]


def main():
    programs = sys.argv[1]
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cases = []
        for title, places in made_up(folder):
            file = folder / (title.replace(" ", "_") + ".csv")
            rows = "".join(f"{complex(p).real},{complex(p).imag}\n" for p in places)
            file.write_text("east_m,north_m\n" + rows)
            cases.append((title, file, [complex(p) for p in places]))
        plans = PROJECT.parent / "shared" / "plans"
        for plan in ("ardupilot/mission_pyramids.plan", "ardupilot/Plockton.waypoints",
                     "qgroundcontrol/qgroundcontrol_sample.plan",
                     "qgroundcontrol/qgroundcontrol_sample_with_survey.plan"):
            if (plans / plan).exists():
                cases.append((plan, plans / plan, on_plane(plan_places(plans / plan))))
            else:
                print(f"skipped: {plan} is not in ../shared/plans")
        for title, file, places in cases:
            expected = flown(places + places[:1])
            straight = sum(abs(b - a) for a, b in zip(places, places[1:] + places[:1]))
            result = measured(programs, folder, file)
            off = [result["length_m"] / expected - 1, result["duration_s"] * SPEED / expected - 1]
            good = max(map(abs, off)) < 0.01
            failures += not good
            print(f"{'ok' if good else 'FAILED'}: {title}: {expected:.1f} m ({straight:.1f} m without turns), "
                  f"length {100 * off[0]:+.3f} %, time {100 * off[1]:+.3f} %")
    sys.exit(1 if failures else 0)


main()
