"""Native solvers against Ipopt, as a Markdown table: the same composition and tolerance, in turns in one call, medians.

Arguments: the command, and optionally the number of repetitions (5). A run that takes minutes is not repeated (the
column "runs" says how many there were), and none goes on for longer than the time limit: a factor against such a run
is a lower bound. Solvers that are not installed are left out, visibly, as is the real artery where BOWSTRING_DATA is
not set, and Ipopt on the finest mesh."""

import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "grid"))
import grid  # noqa: E402
import scenes  # noqa: E402

SOLVERS = ("interior-point", "active-set", "ipopt")  # the last one is what the others are compared with
TOLERANCE = 1e-8
REPEATS = 5
NOT_REPEATED_S = 120.0
TIME_LIMIT_S = 600.0
REFERENCE_MOST_NODES = 1280  # beyond, its static window of 10 mm takes minutes and tens of gigabytes
CASES = (("planar, EI 65, T 10, N = 80", scenes.make("A", "planar", 80, 65, 10)),
         ("planar, EI 65, T 10, N = 640", scenes.make("A", "planar", 640, 65, 10)),
         ("planar, EI 65, T 10, N = 5120", scenes.make("A", "planar", 5120, 65, 10)),
         ("real artery, EI 4857, T 10, N = 200", scenes.make("B", "artery", 200, 4857, 10)))
COLUMNS = ("scene", "solver", "status", "iterations", "factorizations", "runs", "solve, ms", "process, ms",
           "ms per iteration", "of which assembly", "of which linear algebra", "peak memory, MB", "energy, N mm",
           f"{SOLVERS[-1]}'s solve time over this")


def run(bowstring, scene, solver):
    """(result document, process seconds, peak memory in MB) of one process."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "result.json"
        command = [bowstring, "solve", str(scene.file), "--out", str(out)]
        settings = [("solver.type", solver), ("solver.tolerance", TOLERANCE), ("solver.time-limit", TIME_LIMIT_S)]
        for path, value in [*scene.overrides, *settings]:
            command += ["--set", f"{path}={value}"]
        with tempfile.TemporaryFile() as errors:
            seconds, code, usage = timed(command, errors)
            if not out.exists():
                errors.seek(0)
                sys.exit(f"{solver}, {scene.name}: exit {code}\n{errors.read().decode(errors='replace')}")
        return json.loads(out.read_text()), seconds, usage.ru_maxrss / 1024.0


def timed(command, errors):
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=errors)
    _, state, usage = os.wait4(process.pid, 0)  # the resources of this child alone
    process.returncode = os.waitstatus_to_exitcode(state)
    return time.perf_counter() - begin, process.returncode, usage


def measure(bowstring, scene, solvers, repeats):
    """{solver: runs}, in turns, so that what else the machine does meets all alike."""
    runs = {solver: [] for solver in solvers}
    for _ in range(repeats):
        for solver, told in runs.items():
            if not told or told[0][1] < NOT_REPEATED_S:
                told.append(run(bowstring, scene, solver))
    return runs


def figures(runs):
    """Medians over runs; counts and energy are the same in each."""
    document = runs[0][0]
    seconds = {key: statistics.median(told[0]["solver"]["seconds"].get(key) or 0.0 for told in runs)
               for key in ("solve", "evaluation", "factorization")}
    return document, seconds, statistics.median(told[1] for told in runs), statistics.median(told[2] for told in runs)


def share(part, whole):
    return f"{100 * part / whole:.0f} %" if part and whole else "–"


def rows(name, runs, reference):
    told = {solver: figures(members) for solver, members in runs.items()}
    for solver, (document, seconds, process, memory) in told.items():
        solve, said = seconds["solve"], document["solver"]
        compared = solver != reference and reference in told
        against = f"{told[reference][1]['solve'] / solve:.3g}" if compared else ""
        if compared and told[reference][0]["status"] != "converged":
            against = "at least " + against
        yield [name, solver, document["status"], said["iterations"], said["factorizations"] or "–", len(runs[solver]),
               f"{1e3 * solve:.3g}", f"{1e3 * process:.3g}", f"{1e3 * solve / max(said['iterations'], 1):.3g}",
               share(seconds["evaluation"], solve), share(seconds["factorization"], solve), f"{memory:.0f}",
               f"{document['energy']['total']:.10g}", against]


def main(bowstring, repeats=REPEATS):
    offered = grid.offered_solvers(bowstring)
    solvers = [name for name in SOLVERS if name in offered]
    for name in SOLVERS:
        if name not in offered:
            print(f"{name} is left out: this bowstring has no such solver.\n")
    lines = [COLUMNS, ["---"] * len(COLUMNS)]
    for name, scene in CASES:
        if scene.skip:
            print(f"\n{name} is left out: {scene.skip}.")
            continue
        fit = [name for name in solvers if name != SOLVERS[-1] or scene.nodes <= REFERENCE_MOST_NODES]
        lines += rows(name, measure(bowstring, scene, fit, int(repeats)), SOLVERS[-1])
        while lines:
            print("| " + " | ".join(str(cell) for cell in lines.pop(0)) + " |", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
