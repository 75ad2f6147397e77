"""Time against error of every enforcement, by every solver that takes what it leaves, as a Markdown table.

Arguments: the command, and optionally the number of repetitions (3, of which the median time is told). Errors are those
against a solve with exact rows by `active-set` at a hundredth of the tolerance: of the energy, of the contact forces
(relative to the largest) and of the nodes' positions, the largest of all solvers that reach an equilibrium. Then the exponents with which a penalty's errors fall with its
weight. Solvers that are not installed, and the real artery where BOWSTRING_DATA is not set, are left out, visibly."""

import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "grid"))
import grid  # noqa: E402
import scenes  # noqa: E402

SOLVERS = ("interior-point", "active-set", "trust-region", "ipopt")
WEIGHTS = ("1e2", "1e3", "1e4", "1e5", "1e6")
TOLERANCE = 1e-8
TIME_LIMIT_S = 120.0
CASES = (("planar, EI 65, T 10, N = 80", scenes.make("A", "planar", 80, 65, 10)),
         ("real artery, EI 4857, T 10, N = 200", scenes.make("B", "artery", 200, 4857, 10)))
WEIGHT_OF = {f"penalty, {weight} N/mm": float(weight) for weight in WEIGHTS}
METHODS = [("kkt", [])]
METHODS += [(f"penalty, {weight} N/mm", [("enforcement.type", "penalty"), ("enforcement.weight", f"{weight} N/mm")])
            for weight in WEIGHTS]
METHODS += [("penalty, 1e4 N/mm, log-quadratic", [("enforcement.type", "penalty"), ("enforcement.weight", "1e4 N/mm"),
                                                  ("enforcement.form", "log-quadratic")]),
            ("augmented-lagrangian", [("enforcement.type", "augmented-lagrangian")])]
COLUMNS = ("scene", "enforcement", "solves", "penetration, mm", "energy error, N mm", "estimated", "force error, relative",
           "position error, mm", *(f"{solver}: iterations, ms" for solver in SOLVERS))


def solve(bowstring, scene, settings):
    """The result document; None where the solver refuses the problem."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "result.json"
        command = [bowstring, "solve", str(scene.file), "--out", str(out)]
        for path, value in [*scene.overrides, ("solver.time-limit", TIME_LIMIT_S), *settings]:
            command += ["--set", f"{path}={value}"]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        if out.exists():
            return json.loads(out.read_text())
        said = done.stderr.decode(errors="replace")
        if "refuses this problem" in said:
            return None
        sys.exit(f"{command}: exit {done.returncode}\n{said}")


def forces(document):
    return document["state"]["multipliers"]["lumen"]


def points(document):
    return [point for curve in document["curves"] for point in curve["points"]]


def errors(document, exact):
    """Of penetration, energy, forces (relative) and positions."""
    largest = max(abs(force) for force in forces(exact))
    return (document["certificate"]["max_penetration_mm"],
            exact["energy"]["total"] - document["energy"]["total"],
            max(abs(a - b) for a, b in zip(forces(document), forces(exact))) / largest,
            max(math.dist(a, b) for a, b in zip(points(document), points(exact))))


def is_optimal(document):
    """By the figures: all but rows and complementarity, which a penalty leaves."""
    return document["certificate"]["stationarity"] <= 1e-6 and not document["certificate"]["crossings"]


def exponent(weights, values):
    x, y = [math.log(weight) for weight in weights], [math.log(value) for value in values]
    mean_x, mean_y = statistics.mean(x), statistics.mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def measure(bowstring, scene, settings, repeats):
    """(document, median seconds)."""
    told = [solve(bowstring, scene, settings) for _ in range(repeats)]
    if told[0] is None:
        return None, 0.0
    return told[0], statistics.median(document["solver"]["seconds"]["solve"] for document in told)


def cost(document, seconds):
    if document is None:
        return "refused"
    text = f"{document['solver']['iterations']}, {1e3 * seconds:.3g}"
    return text if is_optimal(document) else f"{text}, no: {document['solver']['claim'].split(',')[0]}"


def print_row(cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def main(bowstring, repeats=3):
    offered = grid.offered_solvers(bowstring)
    for name in SOLVERS:
        if name not in offered:
            print(f"{name} is left out: this bowstring has no such solver.\n")
    print_row(COLUMNS)
    print_row(["---"] * len(COLUMNS))
    fits = []
    for name, scene in CASES:
        if scene.skip:
            print(f"\n{name} is left out: {scene.skip}.")
            continue
        exact = solve(bowstring, scene, [("solver.type", "active-set"), ("solver.tolerance", TOLERANCE / 100)])
        fell = []
        for method, settings in METHODS:
            found = [measure(bowstring, scene, [*settings, ("solver.type", solver), ("solver.tolerance", TOLERANCE)],
                             int(repeats)) if solver in offered else (None, 0.0) for solver in SOLVERS]
            reached = [document for document, _ in found if document is not None and is_optimal(document)]
            bias = reached[0]["enforcement"]["bias"]["energy_N_mm"]
            missed = [max(told, key=abs) for told in zip(*(errors(document, exact) for document in reached))]
            if method in WEIGHT_OF:
                fell.append((WEIGHT_OF[method], *missed))
            print_row([name, method, reached[0]["enforcement"]["outer_iterations"], f"{missed[0]:.2e}",
                       f"{missed[1]:.2e}", "–" if bias is None else f"{bias:.2e}", f"{missed[2]:.1e}",
                       f"{missed[3]:.1e}", *(cost(document, seconds) for document, seconds in found)])
        weights, *values = zip(*fell)
        fits.append((name, *(exponent(weights, told) for told in values)))
    print("\nExponents of a penalty's errors in its weight, 1e2 to 1e6 N/mm, by least squares:\n")
    print_row(["scene", "penetration", "energy", "forces", "positions"])
    print_row(["---"] * 5)
    for name, *slopes in fits:
        print_row([name, *(f"{slope:.3f}" for slope in slopes)])


if __name__ == "__main__":
    main(*sys.argv[1:])
