#!/usr/bin/python3
"""Has a sample flight fly past the node, with a roscore of its own, and sets the last prediction next to flightwatt predict
on a log of the same values. Skipped (77) where ROS or its Python is not installed.

usage: node_test.py SOURCE BUILD FOLDER
"""

import json
import math
import os
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path

UNTIL_S = 400.0
REMAINING_S = 300.0
DEFINITIONS = """<log_file><protocol><msg_class NAME="telemetry" ID="1">
<message NAME="ENERGY" ID="37"><field NAME="voltage" TYPE="float" UNIT="V"/><field NAME="current" TYPE="float" UNIT="A"/>
<field NAME="power" TYPE="float" UNIT="W"/><field NAME="charge" TYPE="float" UNIT="Ah"/></message>
<message NAME="ESTIMATOR" ID="42"><field NAME="z" TYPE="float" UNIT="m"/></message>
</msg_class></protocol></log_file>
"""


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


if not shutil.which("roscore"):
    skip("there is no roscore")
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    PORT = free.getsockname()[1]
os.environ.update(ROS_MASTER_URI=f"http://127.0.0.1:{PORT}", ROS_IP="127.0.0.1")
try:
    import rospy
    from geometry_msgs.msg import PoseStamped
    from rosgraph_msgs.msg import Clock
    from sensor_msgs.msg import BatteryState
    from std_msgs.msg import String
except ImportError as error:
    skip(error)


def float32(number):
    """As a BatteryState carries it."""
    return struct.unpack("f", struct.pack("f", number))[0]


def wait_until(condition, what):
    for _ in range(2400):
        if condition():
            return
        time.sleep(0.05)
    sys.exit(f"{what}: not within 2 minutes")


def master_answers():
    with socket.socket() as line:
        return line.connect_ex(("127.0.0.1", PORT)) == 0


def flown(log):
    """Voltage, current and charge drawn of ENERGY, altitude of ESTIMATOR, with their times."""
    samples = []
    for line in open(log, encoding="ascii"):
        words = line.split()
        if float(words[0]) > UNTIL_S:
            break
        if words[2] == "ENERGY":
            voltage, current, charge = (float32(float(words[i])) for i in (4, 5, 7))
            samples.append((float(words[0]), "ENERGY", (voltage, current, charge)))
        elif words[2] == "ESTIMATOR":
            samples.append((float(words[0]), "ESTIMATOR", (float(words[3]),)))
    return samples


def expected(samples, source, build, folder):
    """What flightwatt predict states of a log of the same values."""
    with open(folder / "flown.data", "w", encoding="ascii") as data:
        for time_s, name, values in samples:
            if name == "ENERGY":
                voltage, current, charge = values
                data.write(f"{time_s!r} 1 ENERGY {voltage!r} {current!r} {voltage * current!r} {charge!r}\n")
            else:
                data.write(f"{time_s!r} 1 ESTIMATOR {values[0]!r}\n")
    (folder / "flown.log").write_text(DEFINITIONS)
    fits = source / "fits"
    command = [build / "bin/flightwatt-predict", "flown.data", "--json", "--remaining", str(REMAINING_S),
               "--model", fits / "mechanical/synthetic-wing.toml", "--battery", fits / "battery/synthetic-3s.toml"]
    return json.loads(subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout)


class Flight:
    """The topics on both sides of the node, in a time that the test states."""

    START_S = 1_600_000_000

    def __init__(self):
        rospy.set_param("/use_sim_time", True)
        rospy.init_node("flight", disable_signals=True)
        self.clock = rospy.Publisher("/clock", Clock, queue_size=100_000)
        self.battery = rospy.Publisher("/battery", BatteryState, queue_size=100_000)
        self.pose = rospy.Publisher("/pose", PoseStamped, queue_size=100_000)
        self.predictions = []
        self.decisions = []
        rospy.Subscriber("/flightwatt/prediction", String, lambda text: self.predictions.append(json.loads(text.data)))
        rospy.Subscriber("/flightwatt/decision", String, lambda text: self.decisions.append(json.loads(text.data)))

    def stamp(self, time_s):
        return rospy.Time.from_sec(self.START_S) + rospy.Duration.from_sec(time_s)

    def at(self, time_s):
        self.clock.publish(Clock(self.stamp(time_s)))

    def is_heard(self):
        return all(topic.get_num_connections() for topic in (self.clock, self.battery, self.pose))

    def play(self, samples):
        # What a battery holds, less what was drawn: as ROS has it.
        capacity_ah = 8.0
        said_s = -1.0
        for time_s, name, values in samples:
            if name == "ENERGY":
                voltage, current, charge = values
                message = BatteryState(voltage=voltage, current=-current, charge=capacity_ah - charge)
                message.header.stamp = self.stamp(time_s)
                self.battery.publish(message)
            else:
                message = PoseStamped()
                message.pose.orientation.w = 1.0
                message.pose.position.z = values[0]
                message.header.stamp = self.stamp(time_s)
                self.pose.publish(message)
            if time_s - said_s >= 1.0:
                said_s = time_s
                self.at(time_s)
                time.sleep(0.005)  # 200 times as fast as it was
        time.sleep(2)  # two topics, two connections: all of both has come
        for behind_s in (1.1, 2.2, 3.3):
            self.at(samples[-1][0] + behind_s)
            time.sleep(0.2)


def start_node(build, folder, *parameters):
    with open(folder / "node.err", "w", encoding="utf-8") as err:
        return subprocess.Popen([build / "ros/flightwatt_ros", *parameters], stderr=err, stdout=err)


def check_refusal(build, folder):
    node = start_node(build, folder, "_model:=no-such-model.toml", "_remaining_s:=100.0")
    printed = (folder / "node.err")
    if node.wait(timeout=120) != 3 or "no-such-model.toml" not in printed.read_text():
        sys.exit(f"a model that is not there: {node.returncode}, {printed.read_text()}")


def check_prediction(last, predicted):
    landing = last["landing"]
    wanted = predicted["battery"]["at_landing"]
    pairs = {
        "energy_wh": (landing["energy_wh"], predicted["remaining_energy_wh"]),
        "total_energy_wh": (landing["total_energy_wh"], predicted["total_energy_wh"]),
        "energy_wh_interval_95": (landing["energy_wh_interval_95"]["high"],
                                  predicted["remaining_energy_wh_interval_95"]["high"]),
        "soc_percent": (landing["soc_percent"], wanted["soc_percent"]),
        "voltage_v": (landing["voltage_v"], wanted["voltage_v"]),
    }
    for name, (printed, want) in pairs.items():
        print(f"{name}: {printed} of the node, {want} of predict")
        if not math.isclose(printed, want, rel_tol=1e-4):
            sys.exit(f"{name} differs")


def fly(flight, node, samples):
    """The flight past a node; its last words."""
    del flight.predictions[:], flight.decisions[:]
    wait_until(flight.is_heard, "the node subscribes")
    flight.at(0.0)
    time.sleep(0.5)
    flight.play(samples)
    end_s = flight.START_S + samples[-1][0]
    wait_until(lambda: any(abs(printed["time_s"] - end_s) < 1e-3 for printed in flight.predictions), "the last prediction")
    node.send_signal(signal.SIGINT)
    if node.wait(timeout=120) != 0:
        sys.exit(f"the node ended with {node.returncode}")
    wait_until(lambda: not flight.is_heard(), "the node leaves")
    rospy.delete_param("/flightwatt")
    return flight.predictions[-1]


def main():
    source, build, folder = (Path(word) for word in sys.argv[1:4])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    os.environ["ROS_LOG_DIR"] = str(folder / "logs")
    samples = flown(source / "logs/opterra_synthetic_01.data")
    fits = source / "fits"
    core = subprocess.Popen(["roscore", "-p", str(PORT)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_until(master_answers, "roscore")
        check_refusal(build, folder)
        flight = Flight()
        node = start_node(build, folder, f"_model:={fits}/mechanical/synthetic-wing.toml", f"_remaining_s:={REMAINING_S}",
                          f"_battery:={fits}/battery/synthetic-3s.toml")
        check_prediction(fly(flight, node, samples), expected(samples, source, build, folder))
        if len(flight.predictions) < 50:
            sys.exit(f"{len(flight.predictions)} predictions in {UNTIL_S} s of flight")
        node = start_node(build, folder, f"_mission:={source}/missions/synthetic/thevenin-plan.toml", "_decide:=true",
                          f"_remaining_s:={REMAINING_S}")
        fly(flight, node, samples)
        if not flight.decisions or not flight.decisions[-1]["run"]:
            sys.exit(f"no decision, or nothing runs: {flight.decisions[-1:]}")
        print(flight.decisions[-1])
    finally:
        core.send_signal(signal.SIGINT)
        core.wait(timeout=120)


if __name__ == "__main__":
    main()
