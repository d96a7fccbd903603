"""How binary logs get damaged: as in text_damage.py, of a Log whose `frames` are those of its lines."""

SECTOR = 512  # bytes: what a card writes at once


def whole(log, data):
    """The log is these bytes from now on; their lines are still about what they were."""
    log.frames = [data]


def frames_cut_off(random, log):
    last = random.randrange(len(log.frames))
    log.lines = log.lines[: last + 1]
    frame = log.frames[last]
    log.frames = log.frames[:last] + [frame[: random.randrange(len(frame) + 1)]]


def frames_begun_late(random, log):
    first = random.randrange(len(log.frames))
    log.lines = log.lines[first:]
    frame = log.frames[first]
    log.frames = [frame[random.randrange(len(frame) + 1) :]] + log.frames[first + 1 :]


def sectors(random, data):
    """Some of the card's sectors: where they begin, and where they end."""
    first = random.randrange(len(data) // SECTOR + 1) * SECTOR
    return first, first + random.choice((1, 4, 16)) * SECTOR


def sectors_zeroed(random, log):
    data = b"".join(log.frames)
    for _ in range(random.choice((1, 5))):
        begin, end = sectors(random, data)
        data = data[:begin] + bytes(len(data[begin:end])) + data[end:]
    whole(log, data)


def sectors_moved(random, log):
    data = b"".join(log.frames)
    begin, end = sectors(random, data)
    rest = data[:begin] + data[end:]
    at = random.randrange(len(rest) // SECTOR + 1) * SECTOR
    whole(log, rest[:at] + data[begin:end] + rest[at:])


def sectors_doubled(random, log):
    data = b"".join(log.frames)
    begin, end = sectors(random, data)
    whole(log, data[:end] + data[begin:end] + data[end:])


def contents_changed(random, log):
    """A byte of a message, whose checksum is right nevertheless: it came so."""
    frames = list(log.frames)
    for _ in range(random.choice((1, 10, 100))):
        i = random.randrange(len(frames))
        if frames[i]:
            frame = bytearray(frames[i])
            frame[random.randrange(7, len(frame) - 1)] = random.randrange(256)
            frame[-1] = sum(frame[1:-1]) & 255
            frames[i] = bytes(frame)
    log.frames = frames


DAMAGES = [
    frames_cut_off,
    frames_begun_late,
    sectors_zeroed,
    sectors_moved,
    sectors_doubled,
    contents_changed,
]
