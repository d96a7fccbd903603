"""Puts the logs into chunks of about the same size: a list of paths a chunk, and the names of the chunks.

A log that is in a list already stays there, so that new logs make new chunks and no finished chunk is done again."""

import os
import sys

ENDINGS = (".data", ".LOG", ".tlm", ".TLM")
COMPRESSED = ("", ".gz", ".bz2", ".xz", ".zst")
LOG_ENDINGS = tuple(ending + compressed for ending in ENDINGS for compressed in COMPRESSED)


def logs_of(place):
    if os.path.isfile(place):
        yield place
        return
    if not os.path.isdir(place):
        sys.exit(f"cut_chunks: error: {place}: does not exist; 'logs' of config/config.yaml names folders and files")
    for folder, folders, files in os.walk(place):
        folders.sort()
        yield from (os.path.join(folder, name) for name in sorted(files) if name.endswith(LOG_ENDINGS))


def read_list(file):
    with open(file) as lines:
        return lines.read().splitlines()


def write_list(file, lines):
    with open(file + ".tmp", "w") as out:
        out.writelines(line + "\n" for line in lines)
    os.replace(file + ".tmp", file)


def chunks_of(logs, most_bytes, most_logs):
    chunk, size = [], 0
    for log in logs:
        log_bytes = os.path.getsize(log)
        if chunk and (size + log_bytes > most_bytes or len(chunk) == most_logs):
            yield chunk
            chunk, size = [], 0
        chunk.append(log)
        size += log_bytes
    if chunk:
        yield chunk


def cut(places, lists, most_bytes, most_logs):
    """Writes lists/NNNNNN.txt and returns the names NNNNNN of all."""
    os.makedirs(lists, exist_ok=True)
    names = sorted(name[:-4] for name in os.listdir(lists) if name.endswith(".txt"))
    known = {log for name in names for log in read_list(os.path.join(lists, name + ".txt"))}
    found = dict.fromkeys(log for place in places for log in logs_of(os.path.abspath(place)))
    if any("\n" in log for log in found):
        sys.exit("cut_chunks: error: a log's path holds a newline; rename it")
    for chunk in chunks_of((log for log in found if log not in known), most_bytes, most_logs):
        names.append(f"{int(names[-1]) + 1 if names else 1:06d}")
        write_list(os.path.join(lists, names[-1] + ".txt"), chunk)
    if not names:
        sys.exit(f"cut_chunks: error: no logs in {', '.join(places)}; expected *.data, *.LOG or *.tlm, also compressed")
    return names


parameters = snakemake.params
write_list(
    snakemake.output[0],
    cut(parameters.logs, parameters.lists, parameters.chunk_mb * 1e6, parameters.chunk_logs),
)
