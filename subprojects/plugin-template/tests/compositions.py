"""Solves the compositions with the `bowstring` command and compares them with what is known by hand.

usage: compositions.py BOWSTRING PLUGIN_FOLDER SCENES. Prints 'N passed, N failed'."""

import json
import math
import pathlib
import subprocess
import sys


class Compositions:
    def __init__(self, bowstring, plugins, scenes):
        self.bowstring, self.plugins, self.scenes = bowstring, plugins, pathlib.Path(scenes)
        self.passed = self.failed = 0

    def check(self, good, what):
        self.passed += bool(good)
        self.failed += not good
        if not good:
            print(f"FAIL  {what}")

    def near(self, value, expected, tolerance, what):
        self.check(abs(value - expected) <= tolerance, f"{what}: {value!r}, expected {expected!r} to {tolerance}")

    def solve(self, scene, **overrides):
        """The result document, or nothing where the scene was not solved."""
        command = [self.bowstring, "solve", str(self.scenes / scene), "--plugin-path", self.plugins, "--json"]
        for path, value in overrides.items():
            command += ["--set", f"{path}={value}"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.check(done.returncode == 0, f"{command}\nexit {done.returncode}\n{done.stderr}{done.stdout[:300]}")
        return json.loads(done.stdout) if done.returncode == 0 else None


def anchoring(tests, name, k, slack, exponent, overrides):
    """A force F along the wire moves it as a whole by u = u0 + d (F/(K d))^(1/(m − 1)), K the sum of all stiffness."""
    result = tests.solve("superquadratic-anchoring.toml", **overrides)
    if result is None:
        return
    force, d = 16.0, 2.0
    stretch = (force / (k * d)) ** (1.0 / (exponent - 1.0))
    u = slack + d * stretch
    wire = result["curves"][0]
    moved = [(x - x0, y - y0) for (x, y), (x0, y0) in zip(wire["points"], wire["reference_points"])]
    for pick in (min, max):
        tests.near(pick(along for along, _ in moved), u, 1e-6, f"{name}: displacement along the wire, {pick.__name__}")
    tests.near(max(abs(across) for _, across in moved), 0.0, 1e-6, f"{name}: displacement across it")
    tests.near(result["energy"]["superquadratic-anchoring"], k * d * d / exponent * stretch**exponent, 1e-5,
               f"{name}: energy")


def forces_on(result, name, rows):
    """What acts on one curve besides the plane, and the multipliers of its rows."""
    supports = [entry["force_N"] for entry in result["supports"] if entry["on"] == name]
    return [sum(column) for column in zip([0.0, 0.0], *supports)], result["state"]["multipliers"]["plane"][rows]


def balance(tests, name, normal, load, overrides):
    """Each curve is in balance: what holds it and loads it is what the plane's multipliers push back."""
    result = tests.solve("half-space.toml", **overrides)
    if result is None:
        return None
    length = math.hypot(*normal)
    rods = len(result["curves"][1]["points"]) - 1  # its clamped node has no row
    support, rod = forces_on(result, "rod", slice(0, rods))
    _, vessel = forces_on(result, "vessel", slice(rods, None))
    points, before = result["curves"][0]["points"], result["curves"][0]["reference_points"]
    weights = [1.0 if i in (0, len(points) - 1) else 2.0 for i in range(len(points))]  # of 100 mm in 50 edges, mm
    for k in (0, 1):
        push = sum(rod) * normal[k] / length
        tests.near(support[k] + load[k], push, 1e-6, f"{name}: balance of the rod, axis {k}")
        pull = sum(0.01 * w * (p0[k] - p[k]) for w, p, p0 in zip(weights, points, before))
        tests.near(pull, sum(vessel) * normal[k] / length, 1e-6, f"{name}: balance of the vessel, axis {k}")
    tests.check(min(sum(rod), sum(vessel)) > 0.1, f"{name}: the plane pushes both curves: {sum(rod)}, {sum(vessel)} N")
    tests.check(min(rod + vessel) >= -1e-8, f"{name}: the plane does not pull")
    contacts = result["contacts"]
    tests.check(all(contact["vessel"] is None for contact in contacts), f"{name}: the plane is no vessel")
    tests.near(sum(contact["force_N"] for contact in contacts), sum(rod) + sum(vessel), 1e-9, f"{name}: contacts")
    return result, rod, vessel


def main(bowstring, plugins, scenes):
    tests = Compositions(bowstring, plugins, scenes)

    path = "energy.superquadratic-anchoring."
    anchoring(tests, "as it stands", 1.0, 1.5, 4.0, {})
    anchoring(tests, "without slack", 1.0, 0.0, 4.0, {path + "slack": "0 mm"})
    anchoring(tests, "exponent 3", 1.0, 1.5, 3.0, {path + "exponent": 3})
    anchoring(tests, "exponent 2.5", 1.0, 1.5, 2.5, {path + "exponent": 2.5})
    anchoring(tests, "per node", 51 * 0.04, 1.5, 4.0, {path + "stiffness": "0.04 N/mm"})
    anchoring(tests, "nodes", 1.0, 1.5, 4.0, {"wire.wire.kinematics": "nodes"})

    for kinematics in ("edge-frames", "nodes"):
        solved = balance(tests, kinematics, (0.0, 1.0), (0.0, 0.8),
                         {"wire.rod.kinematics": kinematics, "vessel.vessel.kinematics": kinematics})
        if solved:
            result, rod, vessel = solved
            tests.near(rod[-1], 0.3, 2e-4, f"{kinematics}: the tip's share, to the mesh's error")
            tests.near(sum(rod[:-1]), 0.0, 1e-6, f"{kinematics}: and nothing else of the rod touches")
            tests.near(result["curves"][1]["points"][-1][0], 61.237164, 5e-3, f"{kinematics}: where the tip is")
            tests.near(sum(vessel), 2.0, 1e-6, f"{kinematics}: what moves the vessel by 2 mm")
    solved = balance(tests, "flat on the plane", (0.0, 1.0), (0.0, 20.0),
                     {"constraint.plane.offset": "10 mm", "energy.point-load.force": '["0 N", "20 N"]',
                      "energy.point-load.at": "50 mm", "vessel.vessel.geometry.origin": '["0 mm", "11 mm"]'})
    if solved:
        pressing = [force for force in solved[1] if force > 1e-6]
        tests.check(len(pressing) > 1, f"the rod lies on the plane with several nodes: {pressing}")
    balance(tests, "oblique", (3.0, 4.0), (0.0, 0.8),
            {"constraint.plane.normal": "[3, 4]", "constraint.plane.offset": "80 mm"})

    print(f"{tests.passed} passed, {tests.failed} failed")
    return 1 if tests.failed or not tests.passed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
