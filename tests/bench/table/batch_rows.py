"""A batch beside the sum of its work, its memory over many logs, and how it ends when it is stopped."""

import hashlib
import os
import random
import shutil
import signal
import time

from measure import BenchError, make_flights, say
from rows import Row, at_most

TARGETS = ["programs"]
REAL_LOG = ("--cruise", "4200")  # 4.2 MB
SMALL_LOG = ("--cruise", "60", "--flight-messages-only")
THINNING = 2  # of small logs every second message of a kind: 70 kB
ORIGINALS = 300  # of the small logs, which are linked


def contents(folder):
    """A digest of every file below a folder, by its path in there."""
    files = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                files[os.path.relpath(path, folder)] = hashlib.sha256(file.read()).digest()
    return files


def fresh_batch(bench, inputs, out, *options):
    shutil.rmtree(out, ignore_errors=True)
    return bench.run([bench.program("batch"), *inputs, "-o", out, *options])


def parts_at_once(bench, logs):
    """Seconds of the clock until as many batches as there are cores, each of one job and its part of the logs, have
    ended: the work divided by the cores, while others disturb it as they disturb the batch of all."""
    commands = []
    parts = min(len(bench.cores), len(logs))
    for number in range(parts):
        part = bench.path(f"part{number}")
        shutil.rmtree(part, ignore_errors=True)
        with open(part + ".txt", "w", encoding="utf-8") as file:
            file.writelines(log + "\n" for log in logs[number::parts])
        commands.append([bench.program("batch"), "--files-from", part + ".txt", "-o", part, "--jobs", "1"])
    begin = time.monotonic()
    codes = [batch.wait() for batch in [bench.started(command) for command in commands]]
    if any(codes):
        raise BenchError(f"batches of one job ended with {codes}")
    return time.monotonic() - begin


def beside_its_work(bench, logs):
    say(f"a batch of {len(logs)} real-sized logs, and as one batch a core")
    source, out = os.path.dirname(logs[0]), bench.path("real.out")
    parts_s, wall_s = [], []
    for _ in range(min(3, bench.sizes.rounds)):
        parts_s.append(parts_at_once(bench, logs))
        wall_s.append(fresh_batch(bench, [source], out).wall_s)
    of = f"{len(logs)} of 4 MB"
    ratio = min(wall_s) / min(parts_s)
    by_all = contents(out)
    fresh_batch(bench, [source], out, "--jobs", "1")
    different = different_files(by_all, contents(out))
    shutil.rmtree(out)
    return [
        Row("batch, with its fit", of, min(wall_s), "s", at_most(1.1), "one a core", min(parts_s), ratio),
        Row("files that depend on the jobs", of, different, "files", at_most(0, "files")),
    ]


def different_files(some, others):
    return sum(some.get(path) != others.get(path) for path in {*some, *others})


def stop_and_go_on(bench, source, out, kills, wall_s, how):
    """Stops a batch again and again while it works, and lets it finish; how often it did work then, and the longest
    time to its end [s]."""
    command = [bench.program("batch"), source, "-o", out]
    done, longest_s = 0, 0.0
    for _ in range(kills):
        with bench.started(command) as batch:
            time.sleep(random.uniform(0.0, 1.5 * wall_s / (kills + 1)))
            if batch.poll() is not None:
                continue
            begin = time.monotonic()
            batch.send_signal(how)
            code = batch.wait()
            longest_s = max(longest_s, time.monotonic() - begin)
            if code not in (-how, 128 + how):
                raise BenchError(f"the batch ended with {code} after signal {how}")
            done += 1
    bench.run(command)
    return done, longest_s


def stopped(bench, source):
    """Of the files that a batch leaves that nobody stops, how many are others after it was stopped."""
    kills = bench.sizes.kills
    say(f"a batch that is stopped {kills} times by SIGKILL and by Ctrl-C")
    out = bench.path("stopped.out")
    wall_s = fresh_batch(bench, [source], out).wall_s
    whole = contents(out)
    rows = []
    for how, name in ((signal.SIGKILL, "SIGKILL"), (signal.SIGINT, "Ctrl-C")):
        shutil.rmtree(out)
        done, longest_s = stop_and_go_on(bench, source, out, kills, wall_s, how)
        different = different_files(whole, contents(out))
        of = f"{done} of {kills} times"
        rows.append(Row(f"files that {name} changes", of, different, "files", at_most(0, "files")))
    shutil.rmtree(out)
    rows.append(Row("Ctrl-C ends a batch within", of, longest_s, "s", at_most(1, "s")))
    return rows


def thin(log):
    """Leaves every second message of a kind in a log."""
    seen, kept = {}, []
    with open(log, encoding="ascii") as file:
        for line in file:
            message = line.split(" ", 3)[2]
            seen[message] = seen.get(message, -1) + 1
            if seen[message] % THINNING == 0:
                kept.append(line)
    with open(log, "w", encoding="ascii") as file:
        file.writelines(kept)


def link_logs(bench, originals, count):
    """A list of `count` hard links to logs, in a folder of their own."""
    folder = bench.path(f"links{count}")
    os.mkdir(folder)
    names = []
    for number in range(count):
        log = originals[number % len(originals)]
        name = os.path.join(folder, f"flight_{number:07}")
        os.link(log, name + ".data")
        os.link(log.removesuffix(".data") + ".log", name + ".log")
        names.append(name + ".data\n")
    with open(folder + ".txt", "w", encoding="utf-8") as file:
        file.writelines(names)
    return folder


def memory_of_archive(bench, originals):
    many = bench.sizes.archive
    few = max(1, many // 100)
    memory_mb = []
    for count in (few, many):
        folder = link_logs(bench, originals, count)
        say(f"a batch of {count} small logs")
        out = folder + ".out"
        memory_mb.append(bench.memory_mb([bench.program("batch"), "--files-from", folder + ".txt", "-o", out]))
        shutil.rmtree(out)
        shutil.rmtree(folder)
    ratio = memory_mb[1] / memory_mb[0]
    goal = at_most(500, "MB")
    return Row("memory of a batch", f"{many} logs", memory_mb[1], "MB", goal, f"{few} logs", memory_mb[0], ratio)


def measure(bench):
    say(f"making {bench.sizes.real_logs} logs of 4 MB")
    logs = make_flights(bench, "real", bench.sizes.real_logs, *REAL_LOG)
    rows = beside_its_work(bench, logs)
    shutil.rmtree(os.path.dirname(logs[0]))
    say("making small logs")
    small = make_flights(bench, "small", min(ORIGINALS, bench.sizes.archive), *SMALL_LOG)
    for log in small:
        thin(log)
    return [*rows, *stopped(bench, os.path.dirname(small[0])), memory_of_archive(bench, small)]
