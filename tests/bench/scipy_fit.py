"""Fits the series of fit_series as one would in SciPy: a 231-point frequency scan by linear least squares, then
curve_fit from its best point. Prints a line a series: periods, seconds of the processor, periods found.
usage: scipy_fit.py FOLDER"""

import math
import sys
import time

import numpy as np
from scipy.optimize import curve_fit

ORDER = 3


def basis(time_s, omega):
    columns = [np.ones_like(time_s)]
    for n in range(1, ORDER + 1):
        columns += [np.cos(n * omega * time_s), np.sin(n * omega * time_s)]
    return np.column_stack(columns)


def model(time_s, omega, *coefficients):
    return basis(time_s, omega) @ np.array(coefficients)


def fit(time_s, power_w):
    duration_s = 600.0
    best = None
    for periods in np.linspace(0.5, 12.0, 231):
        omega = 2 * math.pi * periods / duration_s
        matrix = basis(time_s, omega)
        coefficients = np.linalg.lstsq(matrix, power_w, rcond=None)[0]
        residual = float(np.sum((matrix @ coefficients - power_w) ** 2))
        if best is None or residual < best[0]:
            best = (residual, omega, coefficients)
    found, _ = curve_fit(model, time_s, power_w, p0=[best[1], *best[2]])
    return found[0] * duration_s / (2 * math.pi)


for name in ("1", "1.3", "4.2", "10"):
    series = np.loadtxt(f"{sys.argv[1]}/{name}.csv", delimiter=",", skiprows=1)
    seconds = math.inf
    for _ in range(3):
        start = time.process_time()
        periods_found = fit(series[:, 0], series[:, 1])
        seconds = min(seconds, time.process_time() - start)
    print(name, seconds, periods_found)
