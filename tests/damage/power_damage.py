"""How the power that a text log states is wrong: sensors that drop out, drift and hang, and power that comes late."""

import re

from text_damage import POWER_MESSAGES, message_of, shift_times, words_of


def energy_words(line):
    """The words of an ENERGY with its six fields, or the seven of newer definitions; of another line none."""
    words = words_of(line)
    return words if message_of(line) == b"ENERGY" and len(words) in (9, 10) else []


def change_power(random, log, change):
    """Current and power of ENERGY by change(number, seconds since the first); mostly its counters,
    which the aircraft computes from the same, are lost: without them nothing else shows."""
    without_counters = random.random() < 0.7
    first_s = None
    number = 0
    for i, line in enumerate(log.lines):
        words = energy_words(line)
        if not words:
            continue
        try:
            time_s, voltage, current, power = (float(words[k]) for k in (0, 4, 5, 6))
        except ValueError:
            continue
        first_s = time_s if first_s is None else first_s
        number += 1
        changed = change(number, time_s - first_s, current)
        words[5] = b"%.6f" % changed
        words[6] = b"%.6f" % (power + voltage * (changed - current))
        if without_counters:
            words[-2] = words[-1] = b"0"
        log.lines[i] = b" ".join(words) + b"\n"


def power_drops_out(random, log):
    length = random.randrange(1, 6)
    every = random.randrange(2, 10) * length
    factor = random.choice((0.0, 0.0, 0.05, 0.25, 0.5))
    change_power(random, log, lambda number, _, current: current * factor if number % every < length else current)


def power_spikes(random, log):
    length = random.randrange(1, 5)
    every = random.randrange(5, 20) * length
    factor = random.uniform(1.8, 6.0)
    change_power(random, log, lambda number, _, current: current * factor if number % every < length else current)


def current_drifts(random, log):
    """Only the rest after the flight shows: a log that ends with the throttle open is left as it is."""
    last = next((energy_words(line) for line in reversed(log.lines) if message_of(line) == b"ENERGY"), [])
    if not last or not last[3].isdigit() or int(last[3]) > 20:
        return
    rate_a_per_s = random.choice((0.0005, 0.0015, 0.004, -0.0005))
    change_power(random, log, lambda _, since_s, current: current + rate_a_per_s * since_s)


def power_comes_late(random, log):
    """Every power message later than what else happens: a queue on board."""
    late_s = random.choice((5.0, 10.0, 25.0))
    change_power(random, log, lambda _, since_s, current: current)
    for i, line in enumerate(log.lines):
        if message_of(line) in POWER_MESSAGES:
            shift_times(log, i, i + 1, late_s)


def many_clock_jumps(random, log):
    """Forward by seconds, again and again."""
    shift_s = random.uniform(2.0, 15.0)
    jumps = random.randrange(5, 30)
    change_power(random, log, lambda _, since_s, current: current)
    for jump in range(1, jumps):
        shift_times(log, len(log.lines) * jump // jumps, len(log.lines), shift_s)


DEVICES = {
    b"ESC": "<field name='amps' unit='A'/><field name='bat_volts' unit='V'/><field name='power' unit='W'/>"
    "<field name='rpm'/><field name='motor_volts' unit='V'/><field name='energy' unit='Wh'/><field name='motor_id'/>",
    b"POWER_DEVICE": "<field name='node_id'/><field name='circuit'/><field name='current'/><field name='voltage'/>",
}


def one_device_fails(random, log):
    """ENERGY reported by several devices, of which one falls silent, reports nothing, or repeats its last value."""
    message = random.choice(tuple(DEVICES))
    count = random.randrange(2, 7)
    kind = random.choice(("silent", "zero", "little", "frozen"))
    since = random.choice((0.0, random.uniform(0.0, 0.5)))
    lines = []
    last = b"0"
    for i, line in enumerate(log.lines):
        words = energy_words(line)
        if not words:
            lines.append(line)
            continue
        try:
            time_s, voltage, current = (float(words[k]) for k in (0, 4, 5))
        except ValueError:
            continue
        fails = i >= since * len(log.lines)
        for device in range(count):
            drawn = b"%.6f" % (current / count)
            if device == count - 1 and fails:
                if kind == "silent":
                    continue
                drawn = {"zero": b"0", "little": b"%.6f" % (current / count / 100), "frozen": last}[kind]
            elif device == count - 1:
                last = drawn
            volts = b"%.4f" % voltage
            fields = (drawn, volts, b"%.6f" % (float(drawn) * voltage), b"5000", volts, b"0", b"%d" % device)
            if message == b"POWER_DEVICE":
                fields = (b"1", b"%d" % device, drawn, volts)
            lines.append(b" ".join((b"%.3f" % (time_s + 0.001 * device), words[1], message, *fields)) + b"\n")
    log.lines = lines
    if log.definitions:
        element = f"<message name='{message.decode()}'>{DEVICES[message]}</message>"
        defined = re.compile(r'(<message[^>]*NAME="ENERGY")', re.IGNORECASE)
        log.definitions = defined.sub(lambda found: element + found.group(1), log.definitions, count=1)


DAMAGES = [
    power_drops_out,
    power_spikes,
    current_drifts,
    power_comes_late,
    many_clock_jumps,
    one_device_fails,
]
