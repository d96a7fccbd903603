"""Runs flightwatt batch over the logs of a list. A log that is rejected, or is gone, is a result, and the job is done."""

import os
import subprocess
import sys

DONE, INPUT_REJECTED = 0, 3


def run(program, list_file, folder, threads, log):
    command = [program, "batch", "--no-fit", "--files-from", list_file, "--jobs", str(threads), "-o", folder]
    status = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=log).returncode
    # The catalogue is written when all logs were looked at.
    if status == DONE or (status == INPUT_REJECTED and os.path.exists(os.path.join(folder, "flights.csv"))):
        return
    sys.exit(f"batch_chunk: error: flightwatt batch ended with {status}; see {log.name}")


with open(snakemake.params.log, "a") as log_file:
    run(snakemake.params.program, snakemake.input[0], snakemake.params.folder, snakemake.threads, log_file)
with open(snakemake.output[0], "w"):
    pass
