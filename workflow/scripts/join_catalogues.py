"""Joins the catalogues of the chunks: rows in the order of flights, as one batch over all logs writes them."""

import csv
import os
import sys


def read_catalogue(folder):
    """The header and (flight, its lines as they are) of flights.csv; nothing of a chunk whose logs are all gone."""
    file = os.path.join(folder, "flights.csv")
    if not os.path.exists(file):
        return None, {}
    with open(file, newline="") as lines:
        header, *rows = lines.read().splitlines(keepends=True)
    flights = {}
    for row in rows:
        flights.setdefault(next(csv.reader([row]))[0], []).append(row)
    return header, flights


def join(folders, out):
    headers, all_flights, home = set(), {}, {}
    for folder in folders:
        header, flights = read_catalogue(folder)
        headers |= {header} - {None}
        for flight, rows in flights.items():
            if flight in home:
                sys.exit(
                    f"join_catalogues: error: two flights of one name, {flight}, in {home[flight]} and {folder}; "
                    "rename one of the logs"
                )
            home[flight] = folder
            all_flights[flight] = rows
    if len(headers) > 1:
        sys.exit("join_catalogues: error: the chunks were made by different versions of flightwatt: remove the older")
    with open(out, "w", newline="") as lines:
        lines.writelines(sorted(headers))
        for flight in sorted(all_flights, key=os.fsencode):
            lines.writelines(all_flights[flight])


join(snakemake.params.folders, snakemake.output[0])
