"""Node positions and edge frames: one discrete equilibrium, in as many iterations, of second order in the mesh."""

import math

from study_run import expect, number, run

NODES = (50, 100, 200)
TOTAL, ERROR = "energy_total_N_mm", "energy_total_error_N_mm"


def expect_pair(nodes, frames, where):
    expect(number(nodes, "unknowns") < 0.6 * number(frames, "unknowns"), f"{where}: unknowns")
    for column in (TOTAL, "peak_displacement_mm"):
        apart = abs(number(nodes, column) / number(frames, column) - 1)
        expect(apart < 1e-8, f"{where}: {column} is {apart} apart")
    expect(nodes["status"] == frames["status"], f"{where}: {nodes['status']} and {frames['status']}")


def test(study):
    study.expect_runs(3 * 2 * len(NODES))
    for scene in ("planar", "helix", "tortuous"):
        for n in NODES:
            nodes, frames = (study.one(scene=scene, kinematics=kinematics, N=n) for kinematics in ("nodes", "edge-frames"))
            expect_pair(nodes, frames, f"{scene}, N = {n}")
            if (scene, n) == ("tortuous", 50):  # rows 10 mm apart, a clearance of 4.7 mm
                expect(nodes["status"] == "invalid" and "passes through the wall" in nodes["reason"], nodes["reason"])
                continue
            for row in (nodes, frames):
                expect(row["status"] == "converged" and row["second_order"] == "minimum", row["reason"])
                expect(number(row, "iterations") <= (16 if scene != "tortuous" else 30), f"{scene}, N = {n}: {row}")
    for scene in ("planar", "helix"):
        energy = [number(study.one(scene=scene, kinematics="nodes", N=n), TOTAL) for n in NODES]
        order = math.log((energy[1] - energy[0]) / (energy[2] - energy[1]), 2)
        expect(1.7 < order < 2.2, f"{scene}: order {order}")
        errors = [number(row, ERROR) for row in study.pick(scene=scene, kinematics="nodes")]
        expect(errors[0] > 3 * errors[1] > 9 * errors[2] > 0, f"{scene}: errors {errors}")


run("kinematics", test)
