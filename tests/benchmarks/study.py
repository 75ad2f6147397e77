"""What jobs save, and that many runs need no more memory than few, as Markdown tables.

Arguments: the command, the folder of scenes, and optionally the number of rounds (3). Jobs: 200 solves of a planar scene
with 80 nodes, by one process and by two, in turn, wall time of the whole command. Memory: 10 000 runs of a small rod,
the largest memory of the process that solves after so many of them."""

import csv
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

JOBS_STUDY = """schema = 1
base = "{scenes}/planar-iliac-smooth.toml"
[set]
"solver.type" = "{solver}"
[axes]
T = {{ path = "energy.axial-tension.tension", linear = ["1 N", "20 N"], count = 20 }}
EI = {{ path = "energy.wire-bending.bending-stiffness", log = ["65 N mm^2", "6132 N mm^2"], count = 10 }}
"""
MANY_STUDY = """schema = 1
base = "{scenes}/cantilever.toml"
quantities = ["energy.total", "certificate.stationarity"]
[set]
"wire.rod.geometry.nodes" = 11
[axes]
A = {{ path = "energy.wire-bending.bending-stiffness", log = ["100 N mm^2", "10000 N mm^2"], count = 100 }}
F = {{ path = "energy.point-load.force", values = [{forces}] }}
"""


def seconds(bowstring, study, out, *options):
    begin = time.monotonic()
    subprocess.run([bowstring, "study", str(study), "--out", str(out), "--keep", "summary", *options], check=True,
                   stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def measure_jobs(bowstring, scenes, folder, rounds, solver):
    study = folder / f"{solver}.toml"
    study.write_text(JOBS_STUDY.format(scenes=scenes, solver=solver))
    ratios, alone = [], []
    for i in range(rounds):
        one = seconds(bowstring, study, folder / f"{solver}-one-{i}", "--jobs", "1")
        two = seconds(bowstring, study, folder / f"{solver}-two-{i}", "--jobs", "2")
        ratios.append(one / two)
        alone.append(one)
    print(f"| {solver} | {statistics.median(alone):.2f} | {statistics.median(ratios):.2f} |")


def measure_memory(bowstring, scenes, folder):
    study = folder / "many.toml"
    forces = ", ".join(f'["0 N", "{0.001 * (k + 1):.3f} N"]' for k in range(100))
    study.write_text(MANY_STUDY.format(scenes=scenes, forces=forces))
    out = folder / "many"
    whole = seconds(bowstring, study, out, "--jobs", "1")
    lock = json.loads((out / "study.lock.json").read_text())
    memory = [json.loads((out / "runs" / f"{run['hash']}.json").read_text())["peak_memory_MB"] for run in lock["runs"]]
    with open(out / "results.csv", newline="") as stream:
        statuses = [row["status"] for row in csv.DictReader(stream)]
    print(f"\n10 000 runs of a rod with 11 nodes, {statuses.count('converged')} converged: {whole:.1f} s, report "
          f"{(out / 'report.html').stat().st_size / 1e6:.1f} MB\n\n| after runs | peak memory, MB |\n|---|---|")
    for count in (1, 100, 1000, 5000, len(memory)):
        print(f"| {count} | {memory[count - 1]:.1f} |")
    return out


def main():
    bowstring, scenes = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 3
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        print("200 solves, planar-iliac-smooth, N = 80\n\n| solver | one job, s | one over two jobs |\n|---|---|---|")
        for solver in ("interior-point", "ipopt"):
            measure_jobs(bowstring, scenes, folder, rounds, solver)
        measure_memory(bowstring, scenes, folder)


if __name__ == "__main__":
    main()
