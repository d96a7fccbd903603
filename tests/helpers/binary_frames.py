"""Binary logs out of text logs, as SD cards and links hold them. Used by tests/damage, and by scripts/fuzz for seeds."""

import re
import struct
import xml.etree.ElementTree

NUMBERS = {"uint8": "B", "int8": "b", "uint16": "H", "int16": "h", "uint32": "I", "int32": "i", "float": "f", "double": "d"}
TELEMETRY = 1  # the class of what aircraft send


def wire_messages(definitions):
    """Name -> class, id and the fields' names and types, of a .log; empty where it is no XML."""
    try:
        root = xml.etree.ElementTree.fromstring(definitions)
    except xml.etree.ElementTree.ParseError:
        return {}
    messages = {}
    for group in root.iter("msg_class"):
        for message in group.iter("message"):
            of = {key.upper(): value for key, value in message.attrib.items()}
            fields = [{key.upper(): value for key, value in field.attrib.items()} for field in message.iter("field")]
            name, number = of.get("NAME"), of.get("ID", "")
            if name and number.isdigit() and all("TYPE" in field for field in fields):
                kind = int({key.upper(): value for key, value in group.attrib.items()}.get("ID", "1"))
                messages.setdefault(name, (kind, int(number), {field.get("NAME"): field["TYPE"] for field in fields}))
    return messages


def wire_value(kind, word):
    if kind.startswith("char"):
        return word.strip('"').encode("latin-1")[:255]
    number = float(word)
    if NUMBERS[kind] in "fd":
        return struct.pack("<" + NUMBERS[kind], number)
    size = struct.calcsize(NUMBERS[kind])
    return (int(number) % (1 << 8 * size)).to_bytes(size, "little")


def payload_of(types, words):
    """The fields' bytes. Throws ValueError or KeyError where a word is not of its type."""
    payload = b""
    for kind, word in zip(types, words):
        base, array, count = re.fullmatch(r"(\w+)(\[(\d*)\])?", kind).groups()
        values = [word] if base == "char" or not array else word.split(",") if word else []
        parts = b"".join(wire_value(base, value) for value in values)
        if array and not count:
            payload += bytes([len(parts) if base == "char" else len(values)])
        payload += parts
    return payload


def card_frame(message, time_s):
    body = struct.pack("<BBI", len(message), 0, round(time_s * 1e4) % (1 << 32)) + message
    return b"\x99" + body + bytes([sum(body) & 255])


def link_frame(message):
    a = b = 0
    body = bytes([len(message) + 4]) + message
    for byte in body:
        a = (a + byte) & 255
        b = (b + a) & 255
    return b"\x99" + body + bytes([a, b])


def words_of(line):
    return re.findall(r'"[^"]*"|\S+', line.decode("latin-1"))


def message_of(words, messages, version):
    """Header and fields. Throws where they are not as the message is defined, or is no telemetry message."""
    kind, number, fields = messages[words[2]]
    if len(words) != len(fields) + 3 or kind != TELEMETRY:
        raise ValueError
    header = (int(words[1]), number) if version == 1 else (int(words[1]), 255, kind, number)
    return bytes(header) + payload_of(fields.values(), words[3:])


def frames_of(lines, definitions, version, framing="card"):
    """The frame of each line, pprzlink 1 or 2; empty where a line cannot be one: of the ground, or not defined. Those of
    a link have no time: where TIMESTAMP is defined, each follows one."""
    messages = wire_messages(definitions)
    frames = []
    for line in lines:
        words = words_of(line)
        try:
            message = message_of(words, messages, version)
            if framing == "card":
                frames.append(card_frame(message, float(words[0])))
                continue
            frame = link_frame(message)
            if "TIMESTAMP" in messages:
                time_ms = round(float(words[0]) * 1e3) % (1 << 32)
                frame = link_frame(message_of(["", words[1], "TIMESTAMP", time_ms], messages, version)) + frame
            frames.append(frame)
        except (ValueError, KeyError, IndexError, OverflowError, struct.error, AttributeError):
            frames.append(b"")
    return frames


def absent_value(kind):
    base, _, count = re.fullmatch(r"(\w+)(\[(\d*)\])?", kind).groups()
    return '""' if base in ("char", "string") else ",".join(["0"] * int(count or 1))


def lines_as_defined(lines, own, other):
    """The lines as an aircraft of other definitions sends them: their fields by name, 0 for those that they lack."""
    known, wanted = wire_messages(own), wire_messages(other)
    for line in lines:
        words = words_of(line)
        name = words[2] if len(words) > 2 else ""
        if name in known and name in wanted and len(words) == len(known[name][2]) + 3:
            values = dict(zip(known[name][2], words[3:]))
            fields = [values.get(field, absent_value(kind)) for field, kind in wanted[name][2].items()]
            line = (" ".join(words[:3] + fields) + "\n").encode("latin-1")
        yield line
