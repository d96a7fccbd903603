"""Runs flightwatt batch over the logs of a list. A log that is rejected is a result, and the job is done.

The model of the chunk alone is not wanted: that there is none (exit code 4) is no failure either."""

import os
import subprocess
import sys

DONE, INPUT_REJECTED, NO_ANSWER = 0, 3, 4


def run(program, list_file, folder, threads, log):
    with open(list_file) as lines:
        logs = lines.read().splitlines()
    missing = [path for path in logs if not os.path.exists(path)]
    for path in missing:
        print(f"batch_chunk: {path}: is gone since the chunks were cut; it is left out", file=log, flush=True)
    present = [path for path in logs if path not in set(missing)]
    if not present:
        return
    command = [program, "batch", "--jobs", str(threads), "-o", folder, "--", *present]
    status = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=log).returncode
    # The catalogue is written when all logs were looked at, and whatever comes of a fit follows it.
    has_catalogue = os.path.exists(os.path.join(folder, "flights.csv"))
    if status == DONE or (status in (INPUT_REJECTED, NO_ANSWER) and has_catalogue):
        return
    sys.exit(f"batch_chunk: error: flightwatt batch ended with {status}; see {log.name}")


with open(snakemake.params.log, "a") as log_file:
    run(snakemake.params.program, snakemake.input[0], snakemake.params.folder, snakemake.threads, log_file)
with open(snakemake.output[0], "w"):
    pass
