"""flightwatt validate on some of the flights, evenly from all: leaving each out once grows with their square."""

import csv
import os
import subprocess
import sys


def used_flights(folder):
    series = {}
    with open(os.path.join(folder, "flights.csv"), newline="") as rows:
        for row in csv.DictReader(rows):
            if row["used"] == "true":
                series[os.path.join(folder, "flights", row["flight"] + ".series.csv")] = None
    return list(series)


flights = used_flights(snakemake.params.folder)
count = min(snakemake.params.flights, len(flights))
if count < 2:
    sys.exit(
        f"validate_some: error: {count} flights of {len(flights)} that can be used, and leaving one out needs 2; "
        "set validation_flights: 0"
    )
chosen = [flights[i * len(flights) // count] for i in range(count)]
with open(snakemake.log[0], "w") as log, open(snakemake.output[0], "w") as out:
    command = [snakemake.params.program, "validate", "--json", "--", *chosen]
    sys.exit(subprocess.run(command, stdout=out, stderr=log).returncode)
