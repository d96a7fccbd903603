"""How logs get damaged: each function takes a random generator and a Log, and damages it as real ones are.

A Log holds the lines of a .data file and the text of its .log (None without one); of a binary one also the frames of its
lines. Used by scripts/mutate_logs.
"""

import re
from dataclasses import dataclass

POWER_MESSAGES = (b"ENERGY", b"BAT", b"ESC", b"POWER_DEVICE")
OTHER_MESSAGES = (b"ESTIMATOR", b"GPS", b"GPS_INT", b"ROTORCRAFT_FP", b"AIR_DATA", b"AIRSPEED", b"NAVIGATION")


@dataclass
class Log:
    lines: list  # of bytes, with their line breaks
    definitions: str | None
    frames: list | None = None  # of bytes


def words_of(line):
    return line.rstrip(b"\r\n").split(b" ")


def message_of(line):
    words = line.split(b" ", 3)
    return words[2].rstrip() if len(words) > 2 else b""


def present(log, names):
    return [name for name in names if any(message_of(line) == name for line in log.lines)]


def a_message(random, log):
    """Power messages twice as often: what they say matters most."""
    names = present(log, POWER_MESSAGES) * 2 + present(log, OTHER_MESSAGES)
    return random.choice(names) if names else b"ENERGY"


def a_field(random, log, message):
    """The place of a numeric field of the message among a line's words, from 3 on."""
    line = next((line for line in log.lines if message_of(line) == message), b"0 0 X 0")
    return random.randrange(3, max(len(words_of(line)), 4))


def a_stretch(random, log, least=0.005, most=0.2):
    size = max(1, int(len(log.lines) * random.uniform(least, most)))
    begin = random.randrange(max(1, len(log.lines) - size))
    return begin, begin + size


def change_field(log, message, field, change, begin=0, end=None):
    """Replaces a field of the message's lines by change(value), where that is a number."""
    for i in range(begin, len(log.lines) if end is None else end):
        if message_of(log.lines[i]) != message:
            continue
        words = words_of(log.lines[i])
        if len(words) <= field:
            continue
        try:
            value = change(float(words[field]))
        except (ValueError, OverflowError):
            continue
        if value is not None:
            words[field] = value if isinstance(value, bytes) else b"%.6f" % value
            log.lines[i] = b" ".join(words) + b"\n"


def shift_times(log, begin, end, shift_s):
    for i in range(begin, end):
        words = log.lines[i].split(b" ", 1)
        try:
            log.lines[i] = b"%.3f " % (float(words[0]) + shift_s) + words[1]
        except (ValueError, IndexError):
            continue


def lines_lost(random, log):
    part = random.choice((0.01, 0.05, 0.2, 0.5))
    log.lines = [line for line in log.lines if random.random() > part]


def stretch_lost(random, log):
    begin, end = a_stretch(random, log, 0.005, 0.3)
    del log.lines[begin:end]


def message_falls_silent(random, log):
    message = a_message(random, log)
    begin, end = a_stretch(random, log, 0.05, 1.0)
    if random.random() < 0.5:
        end = len(log.lines)
    log.lines = [line for i, line in enumerate(log.lines) if not (begin <= i < end and message_of(line) == message)]


def lines_doubled(random, log):
    part = random.choice((0.01, 0.1, 1.0))
    log.lines = [line for line in log.lines for _ in range(2 if random.random() < part else 1)]


def stretch_doubled(random, log):
    begin, end = a_stretch(random, log)
    log.lines[end:end] = log.lines[begin:end]


def out_of_order(random, log):
    reach = random.choice((3, 20, 200))
    part = random.choice((0.01, 0.1, 1.0))
    keys = [i + (random.uniform(0, reach) if random.random() < part else 0.0) for i in range(len(log.lines))]
    log.lines = [line for _, line in sorted(zip(keys, log.lines), key=lambda pair: pair[0])]


def stretch_moved(random, log):
    begin, end = a_stretch(random, log)
    taken = log.lines[begin:end]
    del log.lines[begin:end]
    at = random.randrange(len(log.lines) + 1)
    log.lines[at:at] = taken


def cut_off(random, log):
    text = b"".join(log.lines)
    log.lines = text[: random.randrange(len(text))].splitlines(keepends=True)


def begun_late(random, log):
    del log.lines[: random.randrange(len(log.lines))]


def bits_flipped(random, log):
    text = bytearray(b"".join(log.lines))
    for _ in range(random.choice((1, 10, 100, 1000))):
        text[random.randrange(len(text))] ^= 1 << random.randrange(8)
    log.lines = bytes(text).splitlines(keepends=True)


def bytes_inserted(random, log):
    text = bytearray(b"".join(log.lines))
    for _ in range(random.choice((1, 20, 200))):
        at = random.randrange(len(text))
        kind = random.randrange(4)
        text[at:at] = (b"\0" * random.randrange(1, 64), b"\n", random.randbytes(random.randrange(1, 40)), b" ")[kind]
    log.lines = bytes(text).split(b"\n")
    log.lines = [line + b"\n" for line in log.lines]


def digits_changed(random, log):
    """One digit of one number on many lines, as a bad link leaves them."""
    for _ in range(random.choice((1, 10, 100))):
        i = random.randrange(len(log.lines))
        line = bytearray(log.lines[i])
        digits = [at for at, byte in enumerate(line) if 48 <= byte < 58]
        if digits:
            line[random.choice(digits)] = 48 + random.randrange(10)
        log.lines[i] = bytes(line)


def clock_jumps(random, log):
    shift_s = random.choice((0.5, 5.0, 50.0, 600.0, 3600.0, 86400.0, 1e6)) * random.choice((1, -1))
    begin = random.randrange(len(log.lines))
    end = len(log.lines) if random.random() < 0.7 else random.randrange(begin, len(log.lines) + 1)
    shift_times(log, begin, end, shift_s)


def wild_times(random, log):
    for _ in range(random.choice((1, 10))):
        begin = random.randrange(len(log.lines))
        shift_times(log, begin, begin + 1, random.choice((-1e9, -100.0, 30.0, 1000.0, 1e6, 1e300)))


def field_lost(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    part = random.choice((0.01, 0.3, 1.0))
    for i, line in enumerate(log.lines):
        if message_of(line) == message and random.random() < part:
            words = words_of(line)
            del words[field : field + 1]
            log.lines[i] = b" ".join(words) + b"\n"


def field_added(random, log):
    message = a_message(random, log)
    part = random.choice((0.01, 0.3, 1.0))
    for i, line in enumerate(log.lines):
        if message_of(line) == message and random.random() < part:
            words = words_of(line)
            words.insert(random.randrange(3, len(words) + 1), b"%d" % random.randrange(100))
            log.lines[i] = b" ".join(words) + b"\n"


def counter_wrapped(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    if random.random() < 0.5:
        wrap = random.choice((0.01, 0.1, 1.0, 256.0, 65.536))
        change_field(log, message, field, lambda value: value % wrap)
    else:
        begin = random.randrange(len(log.lines))
        first = []
        change_field(log, message, field, lambda value: value - (first or first.append(value) or first)[0], begin)


def field_stuck(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    begin, end = a_stretch(random, log, 0.05, 1.0)
    first = []
    change_field(log, message, field, lambda value: (first or first.append(value) or first)[0], begin, end)


def field_wild(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    values = (b"1e308", b"-1e308", b"nan", b"inf", b"-1", b"0", b"65535", b"-32768", b"99999", b"1e6", b"", b"x")
    wild = random.choice(values)
    part = random.choice((0.001, 0.01, 0.1))
    change_field(log, message, field, lambda value: wild if random.random() < part else None)


def field_scaled(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    factor = random.choice((10.0, 100.0, 1000.0, 0.1, 0.01, 0.001, -1.0))
    change_field(log, message, field, lambda value: value * factor)


def message_scaled(random, log):
    message = a_message(random, log)
    factor = random.choice((10.0, 100.0, 0.1))
    for field in range(3, 12):
        change_field(log, message, field, lambda value: value * factor)


def field_offset(random, log):
    message = a_message(random, log)
    field = a_field(random, log, message)
    offset = random.choice((5.0, -5.0, 50.0, 1000.0))
    change_field(log, message, field, lambda value: value + offset)


def energy_words(line):
    """The words of an ENERGY with its six fields, or the seven of newer definitions; of another line none."""
    words = words_of(line)
    return words if message_of(line) == b"ENERGY" and len(words) in (9, 10) else []


def change_power(random, log, change):
    """Current and power of ENERGY by change(number, seconds since the first); mostly its counters,
    which the aircraft computes from the same, are lost: without them nothing else tells."""
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
    """Only the rest after the flight tells: a log that ends with the throttle open is left as it is."""
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
    """ENERGY told by several devices, of which one falls silent, reports nothing, or repeats its last value."""
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


def sender_changes(random, log):
    begin, end = a_stretch(random, log, 0.01, 1.0)
    name = random.choice((b"99", b"", b"ground", b"-1"))
    for i in range(begin, end):
        words = log.lines[i].split(b" ", 2)
        if len(words) == 3:
            log.lines[i] = b" ".join((words[0], name, words[2]))


def decimal_commas(random, log):
    message = a_message(random, log)
    log.lines = [line.replace(b".", b",") if message_of(line) == message else line for line in log.lines]


def windows_breaks(random, log):
    log.lines = [line.rstrip(b"\n") + b"\r\n" for line in log.lines]


def definitions_lost(random, log):
    log.definitions = None


def definitions_cut(random, log):
    if log.definitions:
        log.definitions = log.definitions[: random.randrange(len(log.definitions))]


def definitions_flipped(random, log):
    if log.definitions:
        text = bytearray(log.definitions.encode("latin-1", "replace"))
        for _ in range(random.choice((1, 10, 100))):
            text[random.randrange(len(text))] ^= 1 << random.randrange(8)
        log.definitions = text.decode("latin-1")


def definitions_of_another_release(random, log):
    """A field of a message of power renamed, dropped, moved, or of another unit."""
    if not log.definitions:
        return
    message = a_message(random, log).decode()
    element = re.compile(r'(<message[^>]*NAME="%s"[^>]*>)(.*?)(</message>)' % message, re.DOTALL | re.IGNORECASE)
    found = element.search(log.definitions)
    if not found:
        return
    fields = re.findall(r"<field[^>]*?(?:/>|>.*?</field>)", found.group(2), re.DOTALL)
    if len(fields) < 2:
        return
    at = random.randrange(len(fields))
    kind = random.randrange(4)
    if kind == 0:
        del fields[at]
    elif kind == 1:
        other = random.randrange(len(fields))
        fields[at], fields[other] = fields[other], fields[at]
    elif kind == 2:
        unit = random.choice(("mW", "mA", "mV", "dV", "A", "V", "W", "Wh", "mAh", "cm", "ft", "%"))
        fields[at] = re.sub(r'(UNIT=")[^"]*', r"\g<1>" + unit, fields[at], flags=re.IGNORECASE)
    else:
        fields[at] = re.sub(r'(NAME=")([^"]*)', r"\1\2_2", fields[at], flags=re.IGNORECASE)
    begin, end = found.span(2)
    log.definitions = log.definitions[:begin] + "\n".join(fields) + log.definitions[end:]


DAMAGES = [
    lines_lost,
    stretch_lost,
    message_falls_silent,
    lines_doubled,
    stretch_doubled,
    out_of_order,
    stretch_moved,
    cut_off,
    begun_late,
    bits_flipped,
    bytes_inserted,
    digits_changed,
    clock_jumps,
    wild_times,
    field_lost,
    field_added,
    counter_wrapped,
    field_stuck,
    field_wild,
    field_scaled,
    message_scaled,
    field_offset,
    power_drops_out,
    power_spikes,
    current_drifts,
    power_comes_late,
    many_clock_jumps,
    one_device_fails,
    sender_changes,
    decimal_commas,
    windows_breaks,
    definitions_lost,
    definitions_cut,
    definitions_flipped,
    definitions_of_another_release,
]
