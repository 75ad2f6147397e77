"""Fabricated reports (bowstring.report/1) of every kind that the page must show, each a function without arguments.

    python3 fabricate_reports.py NAME > report.json"""

import hashlib
import itertools
import json
import math
import random
import sys

HOSTILE = 'wire </script><b>"&amp;'  # names are the user's


# A run of which nothing is to be told.
ORDINARY = {"hash": "", "second_order": "minimum", "unknowns": 100, "iterations": 12, "factorizations": 14, "epochs": 2,
            "max_penetration_dense_mm": 1e-6, "min_stretch": 0.99, "setup_seconds": 0.002, "solve_seconds": 0.05}
UNKNOWN = dict.fromkeys(ORDINARY)


def axis(name, labels, numbers=None, unit="", spacing="listed"):
    column = name + ("_" + unit.replace(" ", "_").replace("^", "") if unit else "")
    return {"name": name, "unit": unit, "column": column, "paths": [f"scene.{name}"], "labels": labels,
            "numbers": numbers, "spacing": spacing}


def numeric_axis(name, numbers, unit="", spacing="listed"):
    return axis(name, [f"{number:g} {unit}".strip() for number in numbers], numbers, unit, spacing)


def empty(name, title, axes):
    return {
        "study": {"name": name, "title": title, "file": f"{name}.toml", "version": "0.1.0", "repeats": 3,
                  "target_error": 0.01},
        "headlines": [], "axes": axes, "along": None, "line_axes": [], "quantities": [], "energies": [],
        "runs": {key: [] for key in ("status", "reason", *ORDINARY)} | {"choice": [[] for _ in axes]},
        "lines": [], "effects": [], "sensitivities": [], "inseparable": [], "distributions": [], "shapes": [],
        "shapes_text": "",
    }


def add_run(report, choice, status="converged", reason="", **values):
    """`values`: what differs from an ordinary run; None for what is not known."""
    runs = report["runs"]
    for alternatives, alternative in zip(runs["choice"], choice):
        alternatives.append(alternative)
    runs["status"].append(status)
    runs["reason"].append(reason)
    name = hashlib.sha256(repr(choice).encode()).hexdigest()
    for key, value in (ORDINARY | values | {"hash": name}).items():
        runs[key].append(value)
    return len(runs["status"]) - 1


def quantity(column, unit, values, references=None, reference_text=""):
    errors = None
    if references:
        errors = [None if value is None or reference is None else (value - reference) / (reference or 1)
                  for value, reference in zip(values, references)]
    return {"column": column, "unit": unit, "path": f"quantities.{column}", "reference_text": reference_text,
            "values": values, "references": references, "errors": errors}


def fitted(verdict, order, spread, limit, text):
    return {"verdict": verdict, "order": order, "order_low": order and order - spread,
            "order_high": order and order + spread, "limit": limit, "text": text}


def arch(points, height, dy=0.0):
    return [[300 * i / (points - 1), height * math.sin(math.pi * i / (points - 1)) + dy] for i in range(points)]


def shape(run, label, height):
    contacts = [{"x": x, "y": height * math.sin(math.pi * x / 300) + 3, "fx": 0.02 * (x - 150) / 150, "fy": force,
                 "force_N": math.hypot(0.02 * (x - 150) / 150, force)}
                for x, force in ((70, -0.4), (150, 0.9), (225, -0.55))]
    return {"run": run, "label": label, "contacts": contacts, "curves": [
        {"name": "iliac", "kind": "vessel", "points": arch(61, height), "rest": arch(61, 55)},
        {"name": "lunderquist", "kind": "wire", "points": arch(61, height + 2, 1), "rest": None}]}


def convergence():
    """A mesh study of three axes with failures: formulations that converge at second and first order, one that does
    not settle, one that is exact from the start."""
    meshes = [20, 40, 80, 160, 320, 640]
    contacts = ["same-index-contact", "node-wise-contact", "segment-wise-contact"]
    solvers = ["interior-point", "active-set"]
    report = empty("mesh", "Which contact formulation converges: a tortuous iliac artery with a Lunderquist wire",
                   [numeric_axis("N", meshes), axis("contact", contacts), axis("solver", solvers)])
    report["along"], report["line_axes"] = 0, [1, 2]
    report["study"]["file"] = "studies/mesh-convergence.toml"
    rows = list(itertools.product(range(len(meshes)), range(len(contacts)), range(len(solvers))))
    noise = random.Random(7)
    peak, force, bending, stretch, load = [], [], [], [], []
    for choice in rows:
        mesh, contact, solver = choice
        count = meshes[mesh]
        seconds = 2e-5 * count ** 1.25 * (1, 1.3, 1.9)[contact] * (1, 2.4)[solver] * noise.uniform(0.9, 1.1)
        error = (0.2 * (20 / count) ** 0.3 + 0.05 * (-1) ** mesh, 0.09 * 20 / count, 0.06 * (20 / count) ** 2)[contact]
        status, reason = "converged", ""
        if contact == 0 and count == 640:
            status = "stalled"
            reason = "stationarity 3.1e-4 N: expected at most 1e-06 N; the step got shorter than rounding"
        elif solver == 1 and count >= 320:
            status, reason = "failed", "active-set: the working set changed 500 times without an end"
        elif contact == 2 and count == 20:
            status, reason = "invalid", "the wall is crossed by 0.4 mm between rows"
        nothing = status == "failed"
        add_run(report, choice, status, reason, unknowns=4 * count, iterations=10 + mesh + 7 * solver,
                factorizations=12 + mesh, solve_seconds=None if nothing and count == 640 else seconds,
                second_order=None if nothing else "minimum", max_penetration_dense_mm=None if nothing else error)
        peak.append(None if nothing else 11.8 * (1 + error * (1 if solver == 0 else 1.02)))
        force.append(None if nothing else 2.4 * (1 - error))
        bending.append(None if nothing else 410 * (1 + error))
        stretch.append(None if nothing else 95 * (1 - error))
        load.append(None if nothing else -230 * (1 + 0.3 * error))
    last = "the run with N = 1280, contact = segment-wise-contact, solver = interior-point"
    report["quantities"] = [quantity("peak_displacement_mm", "mm", peak, [11.8] * len(rows), last),
                            quantity("contact_force_N", "N", force)]
    report["energies"] = [{"term": "wire-bending", "values": bending}, {"term": "vessel-strain", "values": stretch},
                          {"term": "axial-tension", "values": load}]
    for contact, solver in itertools.product(range(3), range(2)):
        own = [run for run, choice in enumerate(rows) if choice[1:] == (contact, solver)]
        fit = fitted("does not settle", None, 0, None, "values go up and down by 5 % with the mesh")
        if contact > 0:
            fit = fitted("converges", contact, 0.05, 11.8, f"order {contact} over the last 5 meshes")
        report["lines"].append({"label": f"contact = {contacts[contact]}, solver = {solvers[solver]}",
                                "choice": [contact, solver], "runs": own, "fits": [fit, None]})
    report["headlines"] = [
        {"kind": "recommendation", "lines": [4],
         "text": "Use segment-wise-contact with interior-point: 1 % of peak displacement in 4.9 ms",
         "detail": "It reaches the target at N = 80; node-wise-contact needs N = 320 and 5 times the time for it, "
                   "same-index-contact never gets there."},
        {"kind": "convergence", "text": "active-set above N = 160 is what keeps runs from converging",
         "detail": "5 of 9 failures have solver = active-set and N ≥ 320; of interior-point only same-index-contact "
                   "at N = 640 and segment-wise-contact at N = 20 fail."},
        {"kind": "warning", "text": "same-index-contact does not settle",
         "detail": "Its values go up and down by 5 % with the mesh."},
        {"kind": "failures", "text": "9 of 36 runs did not converge", "detail": ""},
        {"kind": "effect", "text": "The solver changes nothing that converged",
         "detail": "At most 0.4 % of peak displacement."},
    ]
    report["effects"] = [
        {"axis": 1, "from": 0, "to": 2, "quantity": 0, "pairs": 9, "mean": -1.9, "low": -2.6, "high": -1.2,
         "largest": -3.1, "largest_run": 4, "relative": -0.16},
        {"axis": 2, "from": 0, "to": 1, "quantity": 0, "pairs": 12, "mean": 0.01, "low": -0.01, "high": 0.03,
         "largest": 0.05, "largest_run": 1, "relative": 0.0008}]
    report["shapes"] = [shape(rows.index((4, contact, 0)), report["lines"][2 * contact]["label"], height)
                        for contact, height in ((0, 41), (1, 44), (2, 45))]
    report["shapes_text"] = "Drawn in the plane in which the vessel bends most, seen along (0, 0.1, 0.99)."
    return report


def sample(count=200):
    """Two sampled parameters, no formulations."""
    dice = random.Random(3)
    tension = [dice.uniform(1, 20) for _ in range(count)]
    stiffness = [math.exp(dice.uniform(math.log(65), math.log(6132))) for _ in range(count)]
    report = empty("sample", "What tension and stiffness leave uncertain",
                   [numeric_axis("T", tension, "N", "sampled"), numeric_axis("EI", stiffness, "N mm^2", "sampled")])
    peak = []
    for run in range(count):
        fails = stiffness[run] > 2500 and tension[run] > 12
        add_run(report, [run, run], "stalled" if fails else "converged", "no step lowers the energy" if fails else "")
        peak.append(None if fails else 2 + 3 * math.log10(stiffness[run]) - 0.1 * tension[run] + dice.gauss(0, 0.1))
    report["quantities"] = [quantity("peak_displacement_mm", "mm", peak)]
    known = sorted(value for value in peak if value is not None)
    mean = sum(known) / len(known)
    report["distributions"] = [{
        "quantity": 0, "count": len(known), "mean": mean,
        "deviation": math.sqrt(sum((value - mean) ** 2 for value in known) / (len(known) - 1)),
        "quantiles": [[share, known[round(share * (len(known) - 1))]] for share in (0.05, 0.25, 0.5, 0.75, 0.95)],
        "shares": [0.12, 0.86]}]
    report["sensitivities"] = [{"quantity": 0, "at": "T = 10 N, EI = 630 N mm^2", "entries": [
        {"axis": 0, "derivative": -0.098, "elasticity": -0.11}, {"axis": 1, "derivative": 0.0021, "elasticity": 0.14}]}]
    report["inseparable"] = [{"axes": [0, 1], "cosine": -0.997,
                              "text": "Along (1, 0.31) nothing that was looked at changes."}]
    report["headlines"] = [
        {"kind": "effect", "text": "Stiffness explains 86 % of what varies in peak displacement",
         "detail": "Tension explains 12 %; 90 % of the sample lies between 7.2 and 12.6 mm."},
        {"kind": "convergence", "text": "Stiff wires under high tension stall",
         "detail": "EI > 2500 N mm^2 with T > 12 N."}]
    return report


def ablation():
    """Named alternatives without any number, and names that try to be markup."""
    long_name = "bending and anchoring of the whole length, graded"
    axes = [axis(HOSTILE, ["<i>none</i>", "bending only </script>", long_name]),
            axis("gap", ["squared", "distance", "smooth-distance"]), axis("ends", ["pinned", "clamped"])]
    report = empty("ablation", "What each term does " + HOSTILE, axes)
    rows = list(itertools.product(range(3), range(3), range(2)))
    values = []
    for choice in rows:
        add_run(report, choice, solve_seconds=0.01 * (1 + sum(choice)))
        values.append(10 + 1.5 * choice[0] - 0.2 * choice[1] + 0.05 * choice[2])
    report["quantities"] = [quantity("mean_displacement_mm", "mm", values)]
    report["effects"] = [
        {"axis": name, "from": 0, "to": to, "quantity": 0, "pairs": pairs, "mean": mean, "low": mean - 0.1,
         "high": mean + 0.12, "largest": mean * 1.3, "largest_run": to, "relative": mean / 11}
        for name, to, pairs, mean in
        ((0, 2, 6, 3.0), (0, 1, 6, 1.5), (1, 2, 6, -0.4), (1, 1, 6, -0.2), (2, 1, 9, 0.05))]
    report["headlines"] = [{"kind": "effect", "text": f"{HOSTILE} changes the mean displacement most: +3 mm",
                            "detail": "No other axis moves it by more than 0.4 mm. " + "All else is small. " * 20},
                           {"kind": "convergence", "text": "Every run converged", "detail": ""}]
    report["energies"] = [{"term": "wire-bending", "values": [100 + 10 * sum(choice) for choice in rows]},
                          {"term": HOSTILE, "values": [-20.0 * choice[0] for choice in rows]}]
    return report


def failures():
    """Nothing but failures."""
    solvers = ["ipopt", "nlopt"]
    report = empty("failures", "Nothing converged", [numeric_axis("N", [20, 40, 80]), axis("solver", solvers)])
    report["along"], report["line_axes"] = 0, [1]
    for choice in itertools.product(range(3), range(2)):
        status, reason = (("diverged", "the energy fell below −1e12 N mm"),
                          ("refused", "nlopt: found 2 equalities; expected none; take another solver"))[choice[1]]
        add_run(report, choice, status, reason, **UNKNOWN)
    report["quantities"] = [quantity("peak_displacement_mm", "mm", [None] * 6)]
    report["lines"] = [{"label": f"solver = {name}", "choice": [index], "runs": [index, 2 + index, 4 + index],
                        "fits": [None]} for index, name in enumerate(solvers)]
    report["headlines"] = [{"kind": "convergence", "text": "No run converged",
                            "detail": "nlopt was refused for its equalities, ipopt diverged at every mesh."}]
    return report


def large():
    """10 000 runs: 20 meshes, 25 formulations, 20 loads."""
    meshes = [round(10 * 1.35 ** index) for index in range(20)]
    tension = [1 + index for index in range(20)]
    report = empty("large", "Ten thousand runs", [
        numeric_axis("N", meshes), axis("kinematics", ["nodes", "edge-frames", "strains", "spline", "hermite"]),
        axis("contact", [f"contact-{letter}" for letter in "abcde"]), numeric_axis("T", tension, "N", "linear")])
    report["along"], report["line_axes"] = 0, [1, 2, 3]
    rows = list(itertools.product(*(range(len(one["labels"])) for one in report["axes"])))
    dice = random.Random(11)
    peak, force = [], []
    for choice in rows:
        mesh, kinematics, contact, load = choice
        fails = dice.random() < 0.03
        error = 0.3 * (1 + 0.2 * load) * (10 / meshes[mesh]) ** (1 + 0.25 * kinematics) * dice.uniform(0.8, 1.2)
        status, reason = ("stalled", f"stopped after {500 + contact} iterations") if fails else ("converged", "")
        add_run(report, choice, status, reason, unknowns=3 * meshes[mesh],
                solve_seconds=1e-5 * meshes[mesh] * (1 + kinematics) * dice.uniform(0.9, 1.2))
        peak.append(None if fails else 10 * (1 + error))
        force.append(None if fails else 2 - error)
    reference = "the finest run of each load"
    report["quantities"] = [quantity("peak_displacement_mm", "mm", peak, [10.0] * len(rows), reference),
                            quantity("contact_force_N", "N", force)]
    report["energies"] = [{"term": term, "values": [None if value is None else factor * value for value in peak]}
                          for term, factor in (("wire-bending", 30), ("vessel-strain", 12), ("axial-tension", -9))]
    groups = {}
    for run, choice in enumerate(rows):
        groups.setdefault(choice[1:], []).append(run)
    labels = [one["labels"] for one in report["axes"]]
    for (kinematics, contact, load), own in groups.items():
        order = 1 + 0.25 * kinematics
        fit = fitted("converges", order, 0.1, 10.0, f"order {order:g}")
        report["lines"].append({"label": f"{labels[1][kinematics]}, {labels[2][contact]}, {labels[3][load]}",
                                "choice": [kinematics, contact, load], "runs": own, "fits": [fit, None]})
    report["headlines"] = [
        {"kind": "recommendation", "lines": [400], "text": "Use hermite with contact-a", "detail": "1 % in 0.6 ms."},
        {"kind": "convergence", "text": "3 % of the runs stall, all over the study", "detail": ""}]
    return report


def grid():
    """No mesh and no reference: two scenes over many loads and a few stiffnesses, with sensitivities all over."""
    scenes, tension, stiffness = ["planar", "helical"], [20, 1, 2, 5, 10, 15], [65, 500, 1000, 2000, 6132]
    report = empty("grid", "Loads and stiffnesses", [
        axis("scene", scenes), numeric_axis("T", tension, "N"), numeric_axis("EI", stiffness, "N mm^2")])
    report["line_axes"], report["line_over"] = [0, 2], 1
    rows = list(itertools.product(range(2), range(6), range(5)))
    peak = []
    for scene, load, wire in rows:
        thick = wire == 4
        add_run(report, (scene, load, wire), "stalled" if thick else "converged",
                f"stopped after {100 + load} iterations; stationarity {load}.5e-03 N" if thick else "")
        peak.append(None if thick else (2 - scene) * (tension[load] ** 0.5 + 1e-3 * stiffness[wire]))
    report["quantities"] = [quantity("peak_displacement_mm", "mm", peak)]
    report["energies"] = [{"term": "wire-bending", "values": [30 + index for index in range(len(rows))]}]
    for scene, wire in itertools.product(range(2), range(5)):
        own = sorted((run for run, choice in enumerate(rows) if choice[0::2] == (scene, wire)),
                     key=lambda run: tension[rows[run][1]])
        report["lines"].append({"label": f"{scenes[scene]}, EI = {stiffness[wire]} N mm^2", "choice": [scene, wire],
                                "runs": own, "fits": [None]})
    report["sensitivities"] = [
        {"quantity": 0, "at": f"{scenes[scene]}, T = {tension[load]} N, EI = {stiffness[wire]} N mm^2", "entries": [
            {"axis": 2, "derivative": 1e-3, "elasticity": 0.1 + 0.01 * wire},
            {"axis": 1, "derivative": -0.25, "elasticity": -0.5 - 0.001 * load}]}
        for scene, load, wire in rows if wire < 4]
    report["headlines"] = [{"kind": "effect", "text": "1 % more of T lowers peak_displacement_mm by 0.5 %",
                            "detail": "At 48 places, EI = 65 N mm^2 among them."}]
    return report


def parameters():
    """One place, and every parameter a little to either side of it."""
    names = (("T", "N", 10), ("anchoring", "N/mm^2", 0.0064), ("R", "mm", 6))
    report = empty("parameters", "What the peak displacement is sensitive to",
                   [numeric_axis(name, [place, 0.98 * place, 1.02 * place], unit) for name, unit, place in names])
    rows = [(0, 0, 0)] + [tuple(side if one == own else 0 for one in range(3)) for own in range(3) for side in (1, 2)]
    for choice in rows:
        add_run(report, choice)
    report["quantities"] = [quantity("peak_displacement_mm", "mm", [10 + 0.1 * run for run in range(len(rows))])]
    report["energies"] = [{"term": "wire-bending", "values": [30.0] * len(rows)}]
    report["sensitivities"] = [{"quantity": 0, "at": "T = 10 N, anchoring = 0.0064 N/mm^2, R = 6 mm", "entries": [
        {"axis": 0, "derivative": 0.46, "elasticity": 0.4551234}, {"axis": 1, "derivative": -312, "elasticity": -0.2},
        {"axis": 2, "derivative": -0.43, "elasticity": -0.25}]}]
    report["inseparable"] = [{"axes": [0, 1], "cosine": 0.991, "text": "T and anchoring act alike."}]
    return report


REPORTS = {made.__name__: made for made in (convergence, sample, ablation, failures, large, grid, parameters)}

if __name__ == "__main__":
    json.dump(REPORTS[sys.argv[1]](), sys.stdout)
