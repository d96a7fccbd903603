"""Runs a program on a log and keeps how it ended."""

import json
import os
import signal
import subprocess
import threading
import time

HANG_S = 600.0
SILENT_S = 0.5


class Execution:
    """One program on one damaged log: what it printed and how it ended. For `watch -` the log is its standard input."""

    def __init__(self, command, log, folder):
        self.command = command
        self.input = log if "-" in command[1:2] else os.devnull
        begin = time.monotonic()
        outputs = [os.path.join(folder, name) for name in ("stdout", "stderr")]
        with open(self.input, "rb") as given, open(outputs[0], "wb") as out, open(outputs[1], "wb") as err:
            program = subprocess.Popen(command, stdout=out, stderr=err, stdin=given)
            killer = threading.Timer(HANG_S, program.kill)
            killer.start()
            if "--follow" in command:
                end_when_silent(program.pid, outputs[0])
            _, status, usage = os.wait4(program.pid, 0)
            killer.cancel()
        program.returncode = os.waitstatus_to_exitcode(status)
        self.seconds = time.monotonic() - begin
        self.processor_s = usage.ru_utime + usage.ru_stime
        self.memory_kb = usage.ru_maxrss
        self.code = program.returncode
        with open(os.path.join(folder, "stdout"), "rb") as file:
            self.output = file.read()
        with open(os.path.join(folder, "stderr"), "rb") as file:
            self.messages = file.read()

    def warnings(self, folder):
        """The lines that warn, without the place of the log; next to them rejections, which are no silence either."""
        lines = self.messages.replace(folder.encode(), b"").splitlines()
        return {line for line in lines if b"warning:" in line or b"error:" in line or b"rejected" in line}


def end_when_silent(pid, output):
    """Ends a watch that follows a file once it has read all, by the lines of its --json."""
    while os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        with open(output, "rb") as file:
            lines = file.read().splitlines(keepends=True)
        if lines and lines[-1].endswith(b"\n") and json.loads(lines[-1]).get("time_since_message_s", 0.0) >= SILENT_S:
            os.kill(pid, signal.SIGTERM)
            return
        time.sleep(0.05)
