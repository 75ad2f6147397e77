"""Exact transport against LEMON and Python's POT, on the same matrices in one run.

  transport.py BENCHMARK-TRANSPORT [BENCHMARK-TRANSPORT-LEMON]

`exact` is timed with all that it gives, its proof included; LEMON by its `run()` alone; POT inside Python by the faster of
`ot.emd` and `ot.emd2`. Medians. Memory is the growth of a process of its own: its peak in the solve minus what it held
before, matrix and weights read.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

try:
    import numpy
    import ot
except ImportError:
    ot = None

EXACT = sys.argv[1]
LEMON = sys.argv[2] if len(sys.argv) > 2 else None
PIVOTS = 100_000_000  # POT's default ends before large problems do


def say(text):
    print(text, flush=True)


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout) if done.stdout else None


def read_problems(file):
    rows, columns, number = numpy.fromfile(file, numpy.int64, 3)
    numbers = numpy.fromfile(file, float, offset=24)
    a, b = numbers[:rows].copy(), numbers[rows : rows + columns].copy()
    return a, b, [numpy.ascontiguousarray(c) for c in numbers[rows + columns :].reshape(number, rows, columns)]


def pot_seconds(file, repeats):
    """Seconds of every solve by the faster call, and the values."""
    a, b, costs = read_problems(file)
    seconds = {ot.emd: [], ot.emd2: []}
    work = numpy.empty_like(costs[0])
    for _ in range(repeats):
        for cost in costs:
            for call in seconds:
                work[:] = cost  # as if it had just been computed
                start = time.perf_counter()
                call(a, b, work, numItermax=PIVOTS)
                seconds[call].append(time.perf_counter() - start)
    return min(seconds.values(), key=statistics.median), [ot.emd2(a, b, cost, numItermax=PIVOTS) for cost in costs]


def same(values, expected, who):
    for value, reference in zip(values, expected):
        if abs(value - reference) > 1e-8 * abs(reference):
            say(f"\n{who} gives {reference!r} where exact gives {value!r}")


def milliseconds(seconds):
    return "" if seconds is None else f"{1e3 * seconds:.3g}"


def ratio(numerator, denominator):
    return "" if numerator is None else f"{numerator / denominator:.2g}"


def compare(folder, kind, count, number, repeats, warm=False):
    file = os.path.join(folder, "problems")
    run(EXACT, "make", kind, count, 1, number, file)
    exact = run(EXACT, "walk" if warm else "solve", "exact", file, repeats)
    ours = statistics.median(exact["seconds"])
    lemon = pot = None
    if LEMON:
        answer = run(LEMON, file, repeats)
        lemon = statistics.median(answer["seconds"])
        same(exact["value"], answer["value"], "LEMON")
    if ot:
        seconds, values = pot_seconds(file, repeats)
        pot = statistics.median(seconds)
        same(exact["value"], values, "POT")
    os.remove(file)
    pivots = statistics.median(exact["pivots"][1 if warm else 0 :])
    say(
        f"| {kind.replace('walk-', '').replace('-', ' ')} | {count} | {milliseconds(ours)} | {pivots:.0f} | "
        f"{milliseconds(lemon)} | {milliseconds(pot)} | {ratio(lemon, ours)} | {ratio(pot, ours)} |"
    )


HEADER = """| points | n | exact, ms | pivots | LEMON, ms | POT, ms | LEMON / exact | POT / exact |
|---|---|---|---|---|---|---|---|"""

POT_MEMORY = """
import sys, numpy, ot
def resident(what):
    return next(1024 * int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(what))
rows, columns, number = numpy.fromfile(sys.argv[1], numpy.int64, 3)
a, b = numpy.full(rows, 1 / rows), numpy.full(columns, 1 / columns)
cost = numpy.fromfile(sys.argv[1], float, offset=24 + 8 * (rows + columns)).reshape(rows, columns)
ot.emd2(a[:2] * rows / 2, b[:2] * columns / 2, numpy.ones((2, 2)))
open("/proc/self/clear_refs", "w").write("5")
before = resident("VmRSS:")
value = ot.emd2(a, b, cost, numItermax=%d)
print('{"growth": %%d, "value": %%.17g}' %% (resident("VmHWM:") - before, value))
""" % PIVOTS


def memory(folder, count):
    file = os.path.join(folder, "problems")
    run(EXACT, "make", "cloud", count, 1, 1, file)
    ours = run(EXACT, "memory", "exact", file)
    points = run(EXACT, "points", "exact", count)
    pot = run(sys.executable, "-c", POT_MEMORY, file) if ot else None
    os.remove(file)
    matrix = 8 * count * count
    say(f"\n| growth of the process at n = {count}, MB (a matrix has {matrix / 1e6:.0f}) | exact | POT | exact / POT |\n|---|---|---|---|")
    rows = [("beyond a matrix that is given", ours["growth"], pot and pot["growth"])]
    rows.append(("from points", points["growth"], pot and pot["growth"] + matrix))
    for what, by_us, by_pot in rows:
        theirs = f"{by_pot / 1e6:.0f} | {by_us / by_pot:.2g}" if by_pot else " | "
        say(f"| {what} | {by_us / 1e6:.1f} | {theirs} |")
    if pot:
        same([ours["value"]], [pot["value"]], "POT")


def main():
    if not ot:
        say("python3-pot is not installed for this Python: no column of POT.")
    if not LEMON:
        say("Built without LEMON: no column of it.")
    with tempfile.TemporaryDirectory() as folder:
        say("\nCold\n\n" + HEADER)
        for kind in ("cloud", "curve"):
            for count, number, repeats in ((60, 21, 5), (100, 21, 5), (300, 9, 3), (1000, 5, 1)):
                compare(folder, kind, count, number, repeats)
        compare(folder, "curve", 2000, 3, 1)
        for count, number, repeats in ((300, 9, 3), (1000, 5, 1)):
            compare(folder, "weighted-cloud", count, number, repeats)
        say("\nWarm, steps of 0.1 of the spacing (LEMON and POT start anew)\n\n" + HEADER)
        for kind in ("walk-cloud", "walk-curve"):
            for count in (60, 80, 100, 300):
                compare(folder, kind, count, 40, 3, warm=True)
        memory(folder, 5000)


main()
