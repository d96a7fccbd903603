"""How logs get damaged: each function takes a random generator and a Log, and damages it as real ones are.

A Log holds the lines of a .data file and the text of its .log (None without one); of a binary one also the frames of its
lines. Random bits and bytes are left to libFuzzer (tests/fuzz), which knows what code they reach.
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
    """Power messages twice as often: what they state matters most."""
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
    sender_changes,
    decimal_commas,
    windows_breaks,
    definitions_lost,
    definitions_of_another_release,
]
