"""Solves seeded random scenes, re-checks every document, and says what share converged and why the rest did not: see
README.md.

Exit codes: 0; 1 with --check where a promise is broken; 2 where the input is wrong."""

import argparse
import collections
import concurrent.futures
import csv
import dataclasses
import math
import os
import pathlib
import shutil
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "grid"))

import drawing
import results
import summary
from report import Report
from runner import Runner, WrongInput, offered_solvers, recheck, say

NATIVE_SOLVERS = ("interior-point", "active-set")
TIME_LIMIT = 60.0    # s, of a process
SOLVER_LIMIT = 50.0  # s, of the solver itself, which looks at its clock once an iteration: the rest is for the others
CHUNK = 100
# Axes that the table splits by; numbers in bins with these bounds.
SPLIT = {"dimension": None, "shape": None, "kinematics": None, "contact": None, "gap": None, "length": None, "span": None,
         "lumen": None, "load": None, "rows": None, "nodes": (40, 160, 640), "tension_N": (0.05, 1, 5, 15),
         "wire_bending_N_mm2": (50, 300, 1500), "stretch_N": (1, 5, 25), "anchoring_N_per_mm2": (0.006, 0.012, 0.025),
         "clearance_mm": (3, 5, 8), "tube_curvature": (0.1, 0.3, 0.5), "tortuosity": (1.05, 1.2, 1.5)}
COLUMNS = ("solver", "scene", *drawing.AXES, "status", "second_order", "iterations", "factorizations", "epochs", "solve_s",
           "process_s", "energy_N_mm", "not_finite", "rejected", "reason", "result_file")


@dataclasses.dataclass(frozen=True)
class Written:
    """A drawn scene in a file, as the runner takes it."""

    name: str
    file: pathlib.Path
    axes: dict
    overrides: tuple = ()
    after: str = ""
    skip: str = ""


def write_scene(seed, number, group, continuation, folder):
    drawn = drawing.draw(seed, number, group, continuation)
    file = folder / "scenes" / (drawn.name + ".toml")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(drawn.text)
    return Written(drawn.name, file, drawn.axes)


def write_scenes(seed, numbers, group, continuation, folder, jobs):
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        calls = [pool.submit(write_scene, seed, number, group, continuation, folder) for number in numbers]
        return [call.result() for call in calls]


def not_finite(value, path=""):
    """The path of the first number in a part of a document that is none (JSON has null for those), or None."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return path
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, entry in entries:
        found = not_finite(entry, f"{path}.{key}" if path else str(key))
        if found:
            return found
    return None


def numbers_of(document):
    """What has to be finite in every document that claims an answer; the rest may be unknown, which null says as well."""
    certificate = ("stationarity", "max_penetration_mm", "complementarity")
    return {"energy": document["energy"], "state": document["state"],
            "certificate": {key: document["certificate"][key] for key in certificate},
            "points": [curve["points"] for curve in document["curves"]],
            "contacts": [[row["gap_mm"], row["force_N"]] for row in document["contacts"]]}


def row_of(scene, solver, record, document, result_file):
    row = dict.fromkeys(COLUMNS)
    row.update(scene.axes, solver=solver, scene=scene.name, reason="", process_s=record["process_s"])
    if document is None:
        row["status"], row["reason"] = results.status_without_document(record, False)
        return row
    said = document["solver"]
    row.update({key: said[key] for key in ("iterations", "factorizations", "epochs")})
    row.update(status=document["status"], reason=document["reason"], solve_s=said["seconds"]["solve"],
               second_order=document["certificate"].get("second_order"), energy_N_mm=document["energy"]["total"],
               result_file=str(result_file))
    if document["status"] == results.CONVERGED:
        row["not_finite"] = not_finite(numbers_of(document))
    return row


def solve(asked, solvers, folder):
    """Rows of all scenes; documents that converged and hold are dropped chunk by chunk, unless they are to be kept."""
    rows = []
    runner = Runner(asked.bowstring.absolute(), folder, SOLVER_LIMIT, True, row_of)
    for begin in range(0, len(asked.numbers), CHUNK):
        scenes = write_scenes(asked.seed, asked.numbers[begin:begin + CHUNK], asked.group, asked.continuation, folder,
                              asked.jobs)
        chunk = runner.run_all(scenes, solvers, asked.jobs)
        if asked.recheck:
            _, fallen = recheck(str(asked.recheck.absolute()), chunk)
            said = {name: text for name, text in fallen}
            for row in chunk:
                place = os.path.join(*pathlib.Path(row["result_file"] or "/-").parts[-2:])
                row["rejected"] = said.get(place)
        for row in chunk:
            if row["status"] == results.CONVERGED and not asked.keep and not row["rejected"] and not row["not_finite"]:
                pathlib.Path(row["result_file"]).unlink()
        rows += chunk
    return rows


def kind(row):
    return summary.kind_of_failure(row)


def broken_promises(rows, share):
    """[what, solver, scene, details] of everything that must not be. `share`: the least that must converge, or None."""
    found = []
    for row in rows:
        if row["rejected"]:
            found.append(("rejected by the re-check", row, row["rejected"]))
        if row["not_finite"]:
            found.append(("a number that is not finite", row, row["not_finite"]))
        if row["status"] in ("crashed", "killed"):
            found.append((row["status"], row, row["reason"]))
        elif row["process_s"] > TIME_LIMIT:
            found.append((f"over {TIME_LIMIT:g} s", row, f"{row['process_s']:.0f} s"))
        if row["status"] == "refused" and row["group"] == "posed":
            found.append(("refused", row, row["reason"]))
    out = [[what, row["solver"], row["scene"], details[:200]] for what, row, details in found]
    for solver, members in summary.grouped(rows, "solver").items():
        converged = len(summary.converged(members))
        if share is not None and converged < share * len(members) - 1e-9:
            out.append(["too few converge", solver[0], "all",
                        f"{converged} of {len(members)}; expected a share of at least {share:g}"])
    return out


def quantile(values, share):
    values = sorted(value for value in values if value is not None)
    return values[min(len(values) - 1, int(share * len(values)))] if values else None


def bin_of(value, bounds):
    """(order, text): the value itself without bounds."""
    if bounds is None:
        return str(value), str(value)
    for i, bound in enumerate(bounds):
        if value < bound:
            return f"{i}", f"< {bound:g}"
    return f"{len(bounds)}", f"≥ {bounds[-1]:g}"


def converged_of(members):
    converged = len(summary.converged(members))
    return f"{converged} / {len(members)} = {100.0 * converged / len(members):.2f} %"


def summarise(rows, broken):
    report = Report()
    solvers = list(dict.fromkeys(row["solver"] for row in rows))
    by_group = summary.grouped(rows, "group", "solver")
    report.section("Converged", ["group", "solver", "share", "minimum", "saddle", "degenerate", "not judged"],
                   [[*key, converged_of(members)] + [sum(row["second_order"] == verdict for row in summary.converged(members))
                                              for verdict in ("minimum", "saddle", "degenerate", None)]
                    for key, members in by_group.items()])
    kinds = collections.Counter((row["solver"], row["group"], kind(row)) for row in rows
                                if row["status"] != results.CONVERGED)
    report.section("The rest, by cause", ["solver", "group", "cause", "scenes"],
                   [[*key, count] for key, count in kinds.most_common()])
    quantiles = (0.5, 0.9, 0.99, 1.0)
    for key, scale, unit in (("iterations", 1, ""), ("solve_s", 1e3, ", ms"), ("process_s", 1e3, ", ms")):
        report.section(f"{key}{unit}", ["solver", *(f"{100 * q:g} %" for q in quantiles)],
                       [[solver, *(scale * (quantile([row[key] for row in rows if row["solver"] == solver], q) or 0)
                                   for q in quantiles)] for solver in solvers])
    table = []
    for axis, bounds in SPLIT.items():
        parts = {}
        for row in rows:
            parts.setdefault((*bin_of(row[axis], bounds),), {}).setdefault(row["solver"], []).append(row)
        for (_, text), by_solver in sorted(parts.items()):
            table.append([axis, text, *(converged_of(by_solver[solver]) if solver in by_solver else "–" for solver in solvers)])
    report.section("Converged by axis", ["axis", "value", *solvers], table)
    failed = [row for row in rows if row["status"] != results.CONVERGED]
    report.section("Scenes that did not converge", ["solver", "scene", "status", "iterations", "reason"],
                   [[row["solver"], row["scene"], row["status"], row["iterations"], row["reason"][:200]] for row in failed],
                   listed=60)
    report.section("Broken promises", ["what", "solver", "scene", "details"], broken)
    return report


def write_csv(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def parse_numbers(text):
    """"7", "0-99", "3,8,11"."""
    out = []
    for part in text.split(","):
        first, dash, last = part.partition("-")
        out += range(int(first), int(last) + 1) if dash else [int(first)]
    return out


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0], allow_abbrev=False)
    parser.add_argument("bowstring", type=pathlib.Path, nargs="?", help="the built command; not needed with --write")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenes", type=int, default=100, metavar="COUNT")
    parser.add_argument("--scene", type=parse_numbers, metavar="K[-K][,K…]", help="these numbers only")
    parser.add_argument("--group", choices=drawing.GROUPS, default="posed",
                        help="posed (default), or unposed: on purpose without a minimum")
    parser.add_argument("--continuation", action="store_true", help="scenes with a tension say how to fall back on it")
    parser.add_argument("--write", type=pathlib.Path, metavar="FILE", help="write the one --scene to a file, solve nothing")
    parser.add_argument("--solver", action="append", help="repeatable; default: " + ", ".join(NATIVE_SOLVERS))
    parser.add_argument("--recheck", type=pathlib.Path, metavar="PROGRAM")
    parser.add_argument("--check", action="store_true", help="exit 1 where a promise is broken")
    parser.add_argument("--share", type=float, metavar="S", help="with --check: the least share that converges")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="default: random-scenes/ beside the command")
    parser.add_argument("--keep", action="store_true", help="keep the documents of scenes that converge")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--markdown", type=pathlib.Path, metavar="FILE")
    asked = parser.parse_args(arguments)
    asked.numbers = asked.scene if asked.scene is not None else list(range(asked.scenes))
    if asked.write and len(asked.numbers) != 1:
        parser.error("--write FILE: expected one --scene K")
    if not asked.write and not asked.bowstring:
        parser.error("expected the built command, or --scene K --write FILE")
    return asked


def run(asked):
    if asked.write:
        asked.write.write_text(drawing.draw(asked.seed, asked.numbers[0], asked.group, asked.continuation).text)
        return 0
    offered = offered_solvers(str(asked.bowstring.absolute()))
    solvers = asked.solver or [name for name in NATIVE_SOLVERS if name in offered]
    for name in solvers:
        if name not in offered:
            raise WrongInput(f"--solver {name}: this bowstring has no such solver; expected one of: {', '.join(offered)}")
    if asked.recheck and not os.access(asked.recheck, os.X_OK):
        raise WrongInput(f"--recheck {asked.recheck}: expected an executable file")
    folder = (asked.out or asked.bowstring.parent / "random-scenes").absolute()
    shutil.rmtree(folder / "runs", ignore_errors=True)
    shutil.rmtree(folder / "scenes", ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    rows = solve(asked, solvers, folder)
    broken = broken_promises(rows, asked.share if asked.group == "posed" else None)
    write_csv(folder / "scenes.csv", rows)
    made = summarise(rows, broken)
    (folder / "summary.txt").write_text(made.text())
    if asked.markdown:
        asked.markdown.write_text(made.text(markdown=True))
    print(made.text())
    return 1 if asked.check and broken else 0


def main(arguments):
    asked = parse(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # the processes are of other sessions: end them too
    try:
        return run(asked)
    except WrongInput as error:
        say(f"random_scenes: {error}")
        return 2
    except KeyboardInterrupt:
        say("random_scenes: stopped")
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
