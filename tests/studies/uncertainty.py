"""A power law fits the sample: tension and anchoring move the peak displacement, the wire less, the lumen hardly."""

import math

from study_run import expect, number, run

COUNT = 16
RANGES = {"EI_N_mm2": (291, 4857, math.log), "T_N": (5, 15, float), "k_N_per_mm2": (0.01, 0.04, math.log),
          "R": (0.9, 1.1, float)}


def expect_stratified(rows, column):
    """A Sobol sample of 2^m has one point in each of as many equal shares of every range."""
    low, high, scale = RANGES[column]
    shares = [(scale(number(row, column)) - scale(low)) / (scale(high) - scale(low)) for row in rows]
    expect(sorted(int(share * COUNT) for share in shares) == list(range(COUNT)), f"{column} is not stratified: {shares}")


def least_squares(rows, values):
    """Coefficients by elimination in the normal equations."""
    size = len(rows[0])
    system = [[sum(row[i] * row[j] for row in rows) for j in range(size)] +
              [sum(row[i] * value for row, value in zip(rows, values))] for i in range(size)]
    for i in range(size):
        pivot = max(range(i, size), key=lambda k: abs(system[k][i]))
        system[i], system[pivot] = system[pivot], system[i]
        for k in range(size):
            if k != i:
                factor = system[k][i] / system[i][i]
                system[k] = [a - factor * b for a, b in zip(system[k], system[i])]
    return [system[i][size] / system[i][i] for i in range(size)]


def test(study):
    study.expect_runs(COUNT)
    expect(all(row["status"] == "converged" and row["second_order"] == "minimum" for row in study.rows),
           "a run is no minimum")
    for column in RANGES:
        expect_stratified(study.rows, column)
    logs = [[1.0] + [math.log(number(row, column)) for column in RANGES] for row in study.rows]
    peaks = [math.log(number(row, "peak_displacement_mm")) for row in study.rows]
    _, stiffness, tension, anchoring, radius = least_squares(logs, peaks)
    text = f"exponents of the peak: EI {stiffness}, T {tension}, k {anchoring}, R {radius}"
    expect(0.05 < stiffness < 0.2 and 0.5 < tension < 0.8 and -0.65 < anchoring < -0.35 and abs(radius) < 0.4, text)


run("uncertainty", test)
