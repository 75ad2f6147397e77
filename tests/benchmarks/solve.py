"""Speed against error of shipped scenes, as a Markdown table: medians of whole processes, and where the time goes.

Energies are compared with the limit of the mesh (Richardson, order 2, from the two finest meshes of a family). The
real artery is taken from the folder BOWSTRING_DATA, and left out, visibly, where that is not set."""

import json
import os
import statistics
import subprocess
import sys
import time

REPEATS = 7
KINEMATICS = ("edge-frames", "nodes")
ARTERY = "vmr_0110/left_iliofemoral_to_aorta.csv"


def run(bowstring, scene, overrides):
    """One process: its result document, with the wall-clock seconds of the whole process."""
    command = [bowstring, "solve", scene, "--json"]
    for path, value in overrides.items():
        command += ["--set", f"{path}={value}"]
    begin = time.perf_counter()
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    seconds = time.perf_counter() - begin
    if not process.stdout:
        sys.exit(process.stderr.decode())
    return json.loads(process.stdout), seconds


def offers_solver(bowstring, name):
    process = subprocess.run([bowstring, "plugins", "--json"], check=True, stdout=subprocess.PIPE)
    return any((plugin["kind"], plugin["name"]) == ("solver", name) for plugin in json.loads(process.stdout))


def measure(bowstring, scene, overrides):
    results, process = zip(*(run(bowstring, scene, overrides) for _ in range(REPEATS)))
    seconds = {key: statistics.median(result["solver"]["seconds"][key] or 0.0 for result in results)
               for key in ("load", "setup", "solve", "evaluation", "factorization")}
    seconds["process"] = statistics.median(process)
    return results[0], seconds


def line(name, result, seconds, error):
    solve = seconds["solve"]
    cells = [name, result["status"], result["solver"]["iterations"], f"{1e3 * seconds['process']:.0f}",
             f"{1e3 * seconds['load']:.1f}", f"{1e3 * seconds['setup']:.1f}", f"{1e3 * solve:.0f}",
             f"{100 * seconds['evaluation'] / solve:.0f} %", f"{100 * seconds['factorization'] / solve:.0f} %",
             f"{result['energy']['total']:.6g}", error]
    print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)


def family(bowstring, name, scene, variants):
    """Meshes of one scene, finest last: [(label, overrides)]."""
    measured = [(label, *measure(bowstring, scene, overrides)) for label, overrides in variants]
    energies = [result["energy"]["total"] for _, result, _ in measured]
    limit = (4.0 * energies[-1] - energies[-2]) / 3.0 if len(energies) > 1 else None
    for (label, result, seconds), energy in zip(measured, energies):
        error = "" if limit is None else f"{abs(energy - limit) / abs(limit):.1e}"
        line(f"{name}, {label}", result, seconds, error)


def both(kinematics):
    return {"vessel.iliac.kinematics": kinematics, "wire.lunderquist.kinematics": kinematics}


def real_artery(bowstring, scenes):
    folder = os.environ.get("BOWSTRING_DATA")
    if not folder:
        print("\nThe real artery is left out: BOWSTRING_DATA is not set.")
        return
    geometry = (f'{{ type = "csv", file = "{folder}/{ARTERY}", coordinates = "RAS", smoothing = "0.3 mm", '
                'nodes = 250 }')
    overrides = {"vessel.iliac.geometry": geometry, "vessel.iliac.radius": '{ column = "radius_mm" }'}
    for kinematics in KINEMATICS:
        family(bowstring, "real iliofemoral artery", f"{scenes}/tortuous-iliac.toml",
               [(f"{kinematics}, 250 nodes", {**overrides, **both(kinematics)})])


def main(bowstring, scenes):
    print("| scene | status | iterations | process, ms | load, ms | set-up, ms | solve, ms | of which assembly "
          "| of which linear algebra | total energy, N mm | error against the mesh's limit |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    nodes = lambda count: {"vessel.iliac.geometry.nodes": count}
    family(bowstring, "planar, as published", f"{scenes}/planar-iliac.toml", [("80 nodes", nodes(80))])
    for kinematics in KINEMATICS:
        choice = both(kinematics)
        variants = [(f"{kinematics}, {n} nodes", {**choice, **nodes(n)}) for n in (20, 40, 80, 160, 320)]
        family(bowstring, "planar, smooth", f"{scenes}/planar-iliac-smooth.toml", variants)
        if offers_solver(bowstring, "nlopt"):
            variants = [(f"{kinematics}, {n} nodes, nlopt", {**choice, **nodes(n), "solver.type": "nlopt"})
                        for n in (20, 40)]
            family(bowstring, "planar, smooth", f"{scenes}/planar-iliac-smooth.toml", variants)
        family(bowstring, "helix", f"{scenes}/helical-iliac-full.toml",
               [(f"{kinematics}, {n} nodes", {**choice, **nodes(n)}) for n in (30, 60, 120, 240)])
    family(bowstring, "tortuous", f"{scenes}/tortuous-iliac.toml", [(f"{n} nodes", nodes(n)) for n in (100, 200, 400)])
    real_artery(bowstring, scenes)


if __name__ == "__main__":
    main(*sys.argv[1:])
