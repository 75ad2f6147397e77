"""One row of figures per run, from a result document and what was seen of its process; rows as CSV."""

import csv
import json

from scenes import AXES

COLUMNS = ("solver", "grid", "scene", *AXES, "status", "second_order", "weakly_active_count", "iterations",
           "factorizations", "epochs", "evaluations", "solve_s", "total_s", "evaluation_s", "factorization_s",
           "process_s", "cpu_s", "peak_memory_MB", "energy_N_mm", "peak_displacement_mm", "stationarity_N",
           "rounding_floor_N", "max_penetration_mm", "max_penetration_dense_mm", "min_stretch", "crossings", "folds",
           "reason", "solver_sha256", "result_file")

CONVERGED = "converged"
NOT_RUN = ("skipped", "not available")  # neither a success nor a failure of the solver
NO_DOCUMENT = ("killed", "refused", "crashed")  # in addition to the statuses of a result document


def read_json(path):
    """The document of a file, or None where there is none or half of one."""
    try:
        with open(path, encoding="utf-8") as text:
            return json.load(text)
    except (OSError, ValueError):
        return None


def status_without_document(record, warm):
    """Status and reason. Exit codes 2 and 3 are refusals; `warm`: a version without [start] says so by name."""
    if record["killed"]:
        return "killed", f"no end {record['kill_after_s']:g} s after its start"
    text = " ".join(record["stderr"].split())
    if record["exit"] in (2, 3):
        return ("not available" if warm and "'start' is not available" in text else "refused"), text
    return "crashed", f"exit {record['exit']}: {text}"


def row_of(scene, solver, record, document, result_file):
    """A row as a dictionary of COLUMNS; what is unknown is None."""
    row = dict.fromkeys(COLUMNS)
    row.update(zip(AXES, scene.axes), solver=solver, grid=scene.grid, scene=scene.name)
    if record is None:
        row.update(status="skipped", reason=scene.skip or "not run")
        return row
    row.update({key: record[key] for key in ("process_s", "cpu_s", "peak_memory_MB")})
    if document is None:
        row["status"], row["reason"] = status_without_document(record, bool(scene.after))
        return row
    said, certificate, seconds = document["solver"], document["certificate"], document["solver"]["seconds"]
    row.update({key: said[key] for key in ("iterations", "factorizations", "epochs", "evaluations")})
    row.update({f"{key}_s": seconds.get(key) for key in ("solve", "total", "evaluation", "factorization")})
    row.update({key: certificate.get(key)
                for key in ("second_order", "rounding_floor_N", "max_penetration_mm", "max_penetration_dense_mm",
                            "min_stretch")})
    row.update(status=document["status"], reason=document["reason"], stationarity_N=certificate["stationarity"],
               weakly_active_count=len(certificate["weakly_active"] or ()),
               crossings=len(certificate["crossings"] or ()), folds=len(certificate["folds"] or ()),
               energy_N_mm=document["energy"]["total"],
               peak_displacement_mm=document["quantities"]["peak_displacement_mm"], result_file=str(result_file))
    for plugin in document["provenance"]["plugins"]:
        if plugin["kind"] == "solver":
            row["solver_sha256"] = plugin["sha256"]
    return row


def write_csv(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as text:
        writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def node_positions(document):
    """{curve: points}, in mm."""
    return {curve["name"]: curve["points"] for curve in document["curves"]}


def largest_distance(first, second):
    """Largest distance in mm between nodes of equal number, over all curves; infinite where meshes differ."""
    largest = 0.0
    if first.keys() != second.keys():
        return float("inf")
    for curve, points in first.items():
        if len(points) != len(second[curve]):
            return float("inf")
        for p, q in zip(points, second[curve]):
            largest = max(largest, sum((a - b) ** 2 for a, b in zip(p, q)))
    return largest ** 0.5
