#!/usr/bin/env python3
"""Runs the workflow on a real Slurm of two nodes on this machine, kills one of them and the controller on the way, and
compares with one machine's batch: slurm_test [--short] [--logs N] [--programs BIN].

Its munge, slurmctld and two slurmd are this run's own, in a scratch folder; no service of the system is touched, and
nothing stays. Needs root and scripts/install_dependencies cluster; ends with 77 (skipped) where it cannot start."""

import argparse
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
MODEL = os.path.join(ROOT, "fits/mechanical/opterra-table1.toml")
MISSIONS = os.path.join(ROOT, "missions/paper")
SKIPPED = 77
NODES = ("node1", "node2")
BATCH_JOBS = 1  # logs at a time in a batch, of which a kill finds each in the middle

# Without accounting and without cgroups. Jobs of a lost node may start again after cred_expire.
SLURM_CONF = """\
ClusterName=flightwatt
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={folder}/munge.sock,cred_expire=5
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
SwitchType=switch/none
JobCompType=jobcomp/none
ReturnToService=2
SlurmdTimeout=30
KillWait=2
MinJobAge=300
SlurmdParameters=config_overrides
NodeName=node1 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1
NodeName=node2 NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1
PartitionName=all Nodes=ALL Default=YES State=UP
"""


def note(text):
    print(f"slurm_test: {text}", file=sys.stderr, flush=True)


def skip(why):
    note(f"skipped: {why}")
    sys.exit(SKIPPED)


def fail(text):
    note(f"error: {text}")
    sys.exit(1)


def wait_until(what, condition, seconds, pause_s=0.2):
    end = time.monotonic() + seconds
    while not (answer := condition()):
        if time.monotonic() > end:
            fail(f"waited {seconds} s in vain for {what}")
        time.sleep(pause_s)
    return answer


def free_ports(count):
    sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [one.getsockname()[1] for one in sockets]
    for one in sockets:
        one.close()
    return ports


class Cluster:
    """The daemons, each in the foreground as a child of this process."""

    def __init__(self, folder):
        self.folder = folder
        self.environment = {**os.environ, "SLURM_CONF": os.path.join(folder, "slurm.conf")}
        self.daemons = {}
        for inner in ("state", "log", "jobs"):
            os.makedirs(os.path.join(folder, inner))
        host = socket.gethostname().split(".")[0]
        with open(os.path.join(folder, "slurm.conf"), "w") as conf:
            conf.write(SLURM_CONF.format(host=host, folder=folder, ports=free_ports(3)))
        key = os.path.join(folder, "munge.key")
        with open(os.open(key, os.O_CREAT | os.O_WRONLY, 0o400), "wb") as out:
            out.write(os.urandom(1024))

    def start(self, name):
        path = lambda file: os.path.join(self.folder, file)
        if name == "munged":
            command = ["munged", "--foreground", "--force", f"--socket={path('munge.sock')}"]
            command += [f"--{what}-file={path(f'munge.{what}')}" for what in ("key", "pid", "seed")]
        elif name == "slurmctld":
            command = ["slurmctld", "-D"]
        else:
            command = ["slurmd", "-D", "-N", name]
        with open(path(f"log/{name}"), "ab") as log:
            self.daemons[name] = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log)

    def kill(self, name):
        self.daemons[name].kill()
        self.daemons[name].wait()

    def ask(self, *command):
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True)
        return done.stdout if done.returncode == 0 else ""

    def node_state(self, node):
        state = re.search(r"State=(\S+)", self.ask("scontrol", "show", "node", "--oneliner", node))
        return state[1] if state else ""

    def idle(self):
        return all(self.node_state(node).startswith("IDLE") for node in NODES)

    def job_processes(self, node=None):
        """(process, its command) of this cluster's jobs, on a node or on all, with the daemons that watch over them."""
        ours = f"SLURM_CONF={self.environment['SLURM_CONF']}".encode()
        there = f"SLURMD_NODENAME={node}".encode() if node else b"SLURMD_NODENAME="
        found = {}
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                environment = open(f"/proc/{process}/environ", "rb").read()
                if ours not in environment.split(b"\0") or there not in environment:
                    continue
                found[int(process)] = open(f"/proc/{process}/comm").read().strip()
                parent = int(open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()[1])
                if open(f"/proc/{parent}/comm").read().startswith("slurmstepd"):
                    found[parent] = "slurmstepd"
            except OSError:
                continue  # it has ended
        return found

    def kill_node(self, node):
        """As if its power were cut: the daemon and every process of its jobs. Returns the commands that ran."""
        self.kill(node)
        ended = {}
        while left := self.job_processes(node):
            for process in left:
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            ended |= left
            time.sleep(0.05)
        return sorted(ended.values())

    def stop(self):
        for name in (*NODES, "slurmctld", "munged"):
            daemon = self.daemons.get(name)
            if daemon and daemon.poll() is None:
                daemon.terminate()
                try:
                    daemon.wait(10)
                except subprocess.TimeoutExpired:
                    daemon.kill()
                    daemon.wait()
        for process in self.job_processes():
            try:
                os.kill(process, signal.SIGKILL)
            except ProcessLookupError:
                pass


def start_cluster(folder):
    cluster = Cluster(folder)
    try:
        cluster.start("munged")
        wait_until("munged", lambda: os.path.exists(os.path.join(folder, "munge.sock")), 60)
        for name in ("slurmctld", *NODES):
            cluster.start(name)
        wait_until("two idle nodes", cluster.idle, 120)
    except SystemExit:
        cluster.stop()
        for name in ("munged", "slurmctld", *NODES):
            log = os.path.join(folder, "log", name)
            if os.path.exists(log):
                note(f"{name}: " + " | ".join(open(log).read().splitlines()[-3:]))
        skip("Slurm does not start here")
    return cluster


def batch_of_one_machine(program, logs, out):
    begin = time.monotonic()
    done = subprocess.run([program, "batch", logs, "-o", out], capture_output=True, text=True)
    if done.returncode != 3:
        fail(f"the batch of one machine ended with {done.returncode}, not with 3 for its one broken log: {done.stderr}")
    return time.monotonic() - begin


def make_logs(program, folder, count):
    """Synthetic logs, and one that is rejected."""
    most = 500  # synthesize makes no more than 1000 at once
    for seed, made in enumerate(range(0, count, most), 1):
        command = [program, "synthesize", MODEL, "--flights", str(min(most, count - made)), "--seed", str(seed)]
        command += ["--name", f"synthetic_{seed:03d}", "--cruise", "60", "--flight-messages-only", "-o", folder]
        subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    with open(os.path.join(folder, "broken.data"), "w") as broken:
        broken.write("no telemetry\n")


def start_workflow(cluster, folder, logs, programs, chunk_logs):
    """Snakemake in a copy of workflow/, so that nothing of it stays in the source tree."""
    run = os.path.join(folder, "run")
    for part in ("workflow", "config"):
        shutil.copytree(os.path.join(ROOT, part), os.path.join(run, part))
    environment = cluster.environment | {
        "XDG_CACHE_HOME": os.path.join(folder, "cache"),
        "FLIGHTWATT_SLURM_LOGS": os.path.join(folder, "jobs", "%j"),
    }
    settings = {
        "logs": [logs], "programs": programs, "out": "out", "chunk_logs": chunk_logs, "merge_folders": 4, "chunk_threads": BATCH_JOBS,
        "validation_flights": 10,
        "missions": [f"{MISSIONS}/phased.toml"], "missions_to_plan": [f"{MISSIONS}/plan.toml"], "samples": 100,
    }  # fmt: skip
    command = ["snakemake", "--profile", "workflow/profiles/slurm", "--latency-wait", "5", "--config"]
    command += [f"{key}={value}" for key, value in settings.items()]
    with open(os.path.join(folder, "snakemake.log"), "w") as log:
        to_log = {"stdout": log, "stderr": log, "start_new_session": True}
        return subprocess.Popen(command, cwd=run, env=environment, **to_log), os.path.join(run, "out")


def records(out):
    """Time of writing of every record that is there."""
    found = {}
    for folder, _, files in os.walk(os.path.join(out, "chunks")):
        for name in files:
            if name.endswith(".record.json"):
                file = os.path.join(folder, name)
                found[file] = os.stat(file).st_mtime_ns
    return found


def logs_left(process, out):
    """How many logs of the list of a batch have a record in its folder, and how many have none."""
    command = open(f"/proc/{process}/cmdline").read().split("\0")
    file = lambda option: os.path.join(os.path.dirname(out), command[command.index(option) + 1])
    flights = os.path.join(file("-o"), "flights")
    records = os.listdir(flights) if os.path.isdir(flights) else []
    written = sum(name.endswith(".record.json") for name in records)
    with open(file("--files-from")) as listed:
        return written, len(listed.readlines()) - written


def disturb(cluster, workflow, out, is_short):
    """Kills node1 in the middle of a batch, and the controller unless short; starts them again. Returns the records of
    before, and how many batches were killed."""

    def in_the_middle():
        """Stops the batch, so that it is still in the middle when it is killed, however long that takes."""
        if workflow.poll() is not None:
            fail("the workflow ended before a node could be killed")
        for process, name in cluster.job_processes("node1").items():
            if name != "flightwatt":
                continue
            try:
                os.kill(process, signal.SIGSTOP)
                written, left = logs_left(process, out)
            except (OSError, ValueError):
                return False  # it has ended, or has no command line yet
            if written >= 3 and left > 0:  # the broken log's, and more
                return True
            os.kill(process, signal.SIGCONT)
        return False

    wait_until("a batch at work on node1", in_the_middle, 600, 0.01)
    ended = cluster.kill_node("node1")
    before = records(out)
    killed = ended.count("flightwatt")
    note(f"node1 killed with {', '.join(ended)}; {len(before)} flights done")
    if killed == 0:
        fail("node1 was killed, and no batch with it")
    if is_short:
        cluster.start("node1")  # it finds its job absent
        return before, killed
    time.sleep(10)  # Slurm stores what it knows of jobs within 5 s; a controller killed before has forgotten some
    cluster.kill("slurmctld")
    time.sleep(5)
    cluster.start("slurmctld")
    note("controller killed, and started again after 5 s")
    wait_until("node1 to be missed", lambda: cluster.node_state("node1").startswith("DOWN"), 300)
    cluster.start("node1")
    return before, killed


def done_counts(out):
    """How often each flight was done, by the logs of the batches, and how many were found up to date."""
    counts, up_to_date = {}, 0
    chunks = os.path.join(out, "chunks")
    for name in filter(lambda name: name.endswith(".log"), os.listdir(chunks)):
        with open(os.path.join(chunks, name)) as lines:
            for line in lines:
                if reported := re.match(r"flightwatt-batch: \[\d+/\d+\] (.*): (done|up to date)$", line):
                    if reported[2] == "done":
                        counts[reported[1]] = counts.get(reported[1], 0) + 1
                    else:
                        up_to_date += 1
    return counts, up_to_date


def same_bytes(one, other):
    with open(one, "rb") as a, open(other, "rb") as b:
        return a.read() == b.read()


def done_as_often_as_a_kill_allows(counts, before, killed, names):
    """A batch writes a flight's record and then the line that it is done. A killed batch may have lost that line for each
    log that it was at, and for no other flight. The flight's record is then of before the kill, so that the restarted
    job found it done. No kill explains a second line."""
    silent = names - set(counts)
    written = {os.path.basename(file).removesuffix(".record.json") for file in before}
    return (
        set(counts) <= names
        and set(counts.values()) <= {1}
        and len(silent) <= killed * BATCH_JOBS
        and silent <= written
    )  # fmt: skip


def compare(folder, out, before, killed, flights):
    """Prints what must hold, and returns whether it does."""
    after = records(out)
    counts, up_to_date = done_counts(out)
    checks = {
        f"{name} as of one machine": same_bytes(os.path.join(out, name), os.path.join(folder, "whole", name))
        for name in ("model.toml", "flights.csv")
    }
    checks["flights of all as of one machine"] = not subprocess.run(
        ["diff", "-rq", os.path.join(out, "all", "flights"), os.path.join(folder, "whole", "flights")]
    ).returncode
    checks["every log has its record"] = len(after) == flights + 1
    checks["records of before the kill are the same files"] = all(after.get(file) == at for file, at in before.items())
    names = {os.path.basename(file).removesuffix(".record.json") for file in after} - {"broken"}
    checks["every flight done once"] = done_as_often_as_a_kill_allows(counts, before, killed, names)
    checks["the restarted job found flights done"] = up_to_date > 0
    for what, holds in checks.items():
        print(f"{what}: {'yes' if holds else 'NO'}")
    print(f"flights reported done {sum(counts.values())} of {flights}, found done by a restarted job {up_to_date}")
    return all(checks.values())


def run(folder, arguments, programs):
    flights = 60 if arguments.short else arguments.logs
    chunk_logs = 20 if arguments.short else 100
    program = os.path.join(programs, "flightwatt")
    logs = os.path.join(folder, "logs")
    cluster = start_cluster(folder)
    workflow = None
    try:
        make_logs(program, logs, flights)
        whole_s = batch_of_one_machine(program, logs, os.path.join(folder, "whole"))
        begin = time.monotonic()
        workflow, out = start_workflow(cluster, folder, logs, programs, chunk_logs)
        before, killed = disturb(cluster, workflow, out, arguments.short)
        status = workflow.wait(3600)
        workflow_s = time.monotonic() - begin
        jobs = len(os.listdir(os.path.join(folder, "jobs")))
        text = open(os.path.join(folder, "snakemake.log")).read()
        if status != 0:
            fail(f"the workflow ended with {status}:\n{text[-4000:]}")
        print(f"{flights} logs and a broken one, {jobs} jobs; batch on one machine {whole_s:.1f} s, ", end="")
        print(f"workflow with its disturbances {workflow_s:.1f} s")
        return compare(folder, out, before, killed, flights)
    finally:
        if workflow and workflow.poll() is None:
            os.killpg(workflow.pid, signal.SIGKILL)
            workflow.wait()
        cluster.stop()


def end_once(*_):
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    sys.exit(143)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--short", action="store_true", help="60 logs, and only a node is killed")
    parser.add_argument("--logs", type=int, default=2000, metavar="N", help="so many logs (2000)")
    parser.add_argument("--programs", default=os.path.join(ROOT, "build/release/bin"), metavar="BIN")
    arguments = parser.parse_args()
    if os.geteuid() != 0:
        skip("not root: slurmd runs jobs as their users")
    for program in ("munged", "slurmctld", "slurmd", "sbatch", "snakemake"):
        if not shutil.which(program):
            skip(f"{program} is missing; scripts/install_dependencies cluster installs it")
    if not os.access(os.path.join(arguments.programs, "flightwatt"), os.X_OK):
        fail(f"no flightwatt in {arguments.programs}; build it with scripts/build release programs")
    # Ctrl-C, CTest's time limit: through the same ends as any failure.
    signal.signal(signal.SIGTERM, end_once)
    with tempfile.TemporaryDirectory(prefix="flightwatt-cluster.", ignore_cleanup_errors=True) as folder:
        sys.exit(0 if run(folder, arguments, os.path.abspath(arguments.programs)) else 1)


main()
