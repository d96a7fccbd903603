"""Runs programs and measures them: seconds of the clock and of the processor, peaks of memory."""

import dataclasses
import os
import resource
import subprocess
import sys
import time


class BenchError(Exception):
    """What ends a run; `code` is the exit code."""

    def __init__(self, message, code=1):
        super().__init__(message)
        self.code = code


@dataclasses.dataclass(frozen=True)
class Run:
    wall_s: float
    cpu_s: float  # user and system time, of all threads


@dataclasses.dataclass(frozen=True)
class Sizes:
    """How much each row is given."""

    rounds: int = 5  # after one that warms caches; the least counts
    log_mb: int = 250
    flights: int = 1000  # of one page, and of the batch that is run twice
    validated: int = 40  # leave-one-out: of so many flights, and of twice as many
    real_logs: int = 200  # of 4 MB
    archive: int = 100_000  # small logs, beside a hundredth of them
    kills: int = 10
    live_hours: float = 24.0
    least_benchmark_s: float = 0.5  # of Google Benchmark


QUICK = Sizes(
    rounds=1,
    log_mb=2,
    flights=3,
    validated=2,
    real_logs=2,
    archive=20,
    kills=1,
    live_hours=0.85,
    least_benchmark_s=0.0,
)


def say(message):
    print(f"bench: {message} ...", file=sys.stderr, flush=True)


def busy_s():
    """Seconds of the processors, of all programs since the machine started."""
    with open("/proc/stat", encoding="ascii") as file:
        user, nice, system, _, _, irq, soft, *_ = map(int, file.readline().split()[1:])
    return (user + nice + system + irq + soft) / os.sysconf("SC_CLK_TCK")


def own_s():
    own = resource.getrusage(resource.RUSAGE_SELF)
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime


class LoadOfOthers:
    """Which part of the cores other programs had since it was made."""

    def __init__(self):
        self.start = (time.monotonic(), busy_s(), own_s())

    def part(self):
        clock_s, all_s, ours_s = (now - start for now, start in zip((time.monotonic(), busy_s(), own_s()), self.start))
        return max(0.0, all_s - ours_s) / (clock_s * os.cpu_count())


class Bench:
    """Where programs and temporary files are, and how large the inputs."""

    def __init__(self, root, build, folder, sizes, sample):
        self.root, self.build, self.folder, self.sizes, self.sample = root, build, folder, sizes, sample
        self.cores = sorted(os.sched_getaffinity(0))
        self.output = os.path.join(folder, "stdout")

    def path(self, *names):
        """Of a temporary file."""
        return os.path.join(self.folder, *names)

    def source(self, *names):
        return os.path.join(self.root, *names)

    def program(self, stage):
        return os.path.join(self.build, "bin", f"flightwatt-{stage}")

    def benchmark(self, name):
        return os.path.join(self.build, "tests/bench", name)

    def started(self, command, one_core=False, variables=None):
        """The process of a command; its output goes to files. One core is the last: the first serves interrupts."""
        pinned = ["taskset", "-c", str(self.cores[-1])] if one_core else []
        # Not to /dev/null: grep stops at the first match there.
        environment = dict(os.environ, **(variables or {}))
        with open(self.output, "wb") as out, open(self.output + ".errors", "wb") as errors:
            return subprocess.Popen(
                pinned + command, stdin=subprocess.DEVNULL, stdout=out, stderr=errors, env=environment
            )

    def run(self, command, one_core=False, variables=None):
        """A command that has to end with 0."""
        begin = time.monotonic()
        process = self.started(command, one_core, variables)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:  # also of a signal: nothing goes on in a folder that is removed
            process.kill()
            process.wait()
            raise
        wall_s = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            with open(self.output + ".errors", encoding="utf-8", errors="replace") as file:
                last = file.read().strip().splitlines()[-3:]
            raise BenchError(f"'{' '.join(command)}' ended with {process.returncode}: {'; '.join(last)}")
        return Run(wall_s, usage.ru_utime + usage.ru_stime)

    def memory_mb(self, command):
        """The peak of its resident memory, pages of mapped files included. By GNU time, which is small: what the kernel
        says of a process begins with the memory of the one that started it."""
        said = self.path("memory")
        self.run(["/usr/bin/time", "--format", "%M", "--output", said, *command])
        with open(said, encoding="ascii") as file:
            return int(file.read()) * 1024 / 1e6

    def printed(self):
        """What the last command printed."""
        with open(self.output, encoding="utf-8") as file:
            return file.read()

    def least(self, commands, rounds=None):
        """Runs of {name: (command, one core alone)}, by turns, so that what disturbs the machine disturbs all; of each
        the least seconds."""
        runs = {name: [] for name in commands}
        for number in range((rounds or self.sizes.rounds) + 1):
            for name, (command, one_core) in commands.items():
                run = self.run(command, one_core, {"LC_ALL": "C"})
                if number > 0:
                    runs[name].append(run)
        return {name: least_of(of_name) for name, of_name in runs.items()}


def least_of(runs):
    return Run(min(run.wall_s for run in runs), min(run.cpu_s for run in runs))


def make_flights(bench, folder, count, *options):
    """Synthetic logs, each of its own content; their paths."""
    model = bench.source("fits/mechanical/opterra-table1.toml")
    made = bench.path(folder)
    bench.run([bench.program("synthesize"), model, "--flights", str(count), "--seed", "7", "-o", made, *options])
    return sorted(os.path.join(made, name) for name in os.listdir(made) if name.endswith(".data"))
