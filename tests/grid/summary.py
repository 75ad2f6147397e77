"""What rows of a grid say together: counts, spreads, fits, agreement of solvers, and what was expected."""

import collections
import itertools
import math
import statistics

from results import CONVERGED, NOT_RUN
from scenes import AXES

SAME_BASIN = 1e-3  # relative energy difference
RATIO_NODES = (80, 1280)
FIT_FROM_NODES = 80

# Per grid: what `unmet` asks of a row, by the names of EXPECTATIONS.
EXPECTED = {
    "A": {"converged": None, "minimum": None, "stationarity": 1e-8},
    "B": {"converged": None, "minimum": None, "not-tunnelled": None, "iterations": 35, "peak": 0.01},
    "C": {"converged": None},
    "W": {"converged": None},
}


def ran(rows):
    return [row for row in rows if row["status"] not in NOT_RUN]


def converged(rows):
    return [row for row in rows if row["status"] == CONVERGED]


def grouped(rows, *keys):
    """{key or tuple of keys: rows}, in order of appearance."""
    groups = collections.defaultdict(list)
    for row in rows:
        values = tuple(row[key] for key in keys)
        groups[values if len(keys) > 1 else values[0]].append(row)
    return dict(groups)


def family(row):
    """All axes but the mesh."""
    return (row["grid"],) + tuple(row[axis] for axis in AXES if axis != "nodes")


def part(row):
    """Formulations of contact differ too much to be taken together."""
    return f"{row['grid']} {row['contact']}"


def by_part(rows):
    """{(part, solver, nodes): rows}, sorted."""
    groups = collections.defaultdict(list)
    for row in rows:
        groups[part(row), row["solver"], row["nodes"]].append(row)
    return dict(sorted(groups.items()))


def families(rows):
    """{(solver, family): rows, coarse first}."""
    groups = collections.defaultdict(list)
    for row in sorted(rows, key=lambda row: row["nodes"]):
        groups[row["solver"], family(row)].append(row)
    return dict(groups)


def status_counts(rows):
    """{(grid, solver): Counter of statuses}."""
    return {key: collections.Counter(row["status"] for row in group)
            for key, group in grouped(rows, "grid", "solver").items()}


def failures(rows):
    return [row for row in ran(rows) if row["status"] != CONVERGED]


def kind_of_failure(row):
    """Status and reason without the figures and places that differ from scene to scene."""
    words = (row["reason"] or "").split()
    return row["status"] + ": " + " ".join(word for word in words if not any(c.isdigit() for c in word))[:100]


def figures_by_nodes(rows, key):
    """{(part, solver, nodes): (count, median, largest)} of `key` over converged rows."""
    out = {}
    for group, members in by_part(converged(rows)).items():
        values = [row[key] for row in members if row[key] is not None]
        if values:
            out[group] = (len(values), statistics.median(values), max(values))
    return out


def iteration_ratios(rows, low=RATIO_NODES[0], high=RATIO_NODES[1]):
    """{(solver, family): (fewest, most, most/fewest)} over meshes with low ≤ N ≤ high, of families with two or more."""
    out = {}
    for key, members in families(converged(rows)).items():
        counts = [row["iterations"] for row in members if low <= row["nodes"] <= high and row["iterations"]]
        if len(counts) > 1:
            out[key] = (min(counts), max(counts), max(counts) / min(counts))
    return out


def shared_slope(groups):
    """Least-squares slope of log y over log x that all groups of (x, y) share, each with an intercept of its own; None
    where no group has two different x."""
    xx = xy = 0.0
    for points in groups:
        logs = [(math.log(x), math.log(y)) for x, y in points if x > 0.0 and y > 0.0]
        if len(logs) < 2:
            continue
        mean_x = sum(x for x, _ in logs) / len(logs)
        mean_y = sum(y for _, y in logs) / len(logs)
        xx += sum((x - mean_x) ** 2 for x, _ in logs)
        xy += sum((x - mean_x) * (y - mean_y) for x, y in logs)
    return xy / xx if xx > 0.0 else None


def time_exponents(rows, key="solve_s"):
    """{(part, solver): exponent or None} of `key` over N."""
    points = collections.defaultdict(list)
    for (solver, _), members in families(converged(rows)).items():
        points[part(members[0]), solver].append([(row["nodes"], row[key]) for row in members
                                         if row["nodes"] >= FIT_FROM_NODES and row[key]])
    return {group: shared_slope(values) for group, values in points.items()}


def ratios_to(rows, reference, key="solve_s"):
    """{(part, solver, nodes): (count, median of key/key of the reference)} over scenes that both solved."""
    told = {row["scene"]: row[key] for row in converged(rows) if row["solver"] == reference and row[key]}
    out = {}
    for group, members in by_part(converged(rows)).items():
        ratios = [row[key] / told[row["scene"]] for row in members if row["scene"] in told and row[key]]
        if ratios and group[1] != reference:
            out[group] = (len(ratios), statistics.median(ratios))
    return out


def relative_difference(first, second):
    scale = max(abs(first), abs(second))
    return abs(first - second) / scale if scale > 0.0 else 0.0


def agreement(rows, distance):
    """Pairs of solvers that both solved a scene: [(solver, solver, scene, relative energy difference, largest node
    distance in mm)]. `distance(row, row)` gives the last."""
    out = []
    for scene, members in grouped(converged(rows), "scene").items():
        for first, second in itertools.combinations(members, 2):
            difference = relative_difference(first["energy_N_mm"], second["energy_N_mm"])
            out.append((first["solver"], second["solver"], scene, difference, distance(first, second)))
    return out


def peak_differences(rows):
    """{(solver, family): (coarse peak, fine peak, relative difference)} of families that converged on two meshes and
    more, by their coarsest and finest."""
    out = {}
    for key, members in families(converged(rows)).items():
        members = [row for row in members if row["peak_displacement_mm"] is not None]
        if len(members) > 1:
            coarse, fine = members[0]["peak_displacement_mm"], members[-1]["peak_displacement_mm"]
            out[key] = (coarse, fine, relative_difference(coarse, fine))
    return out


def miss_converged(row, _):
    return row["status"] != CONVERGED and f"{row['status']}: {row['reason']}"


def miss_minimum(row, _):
    return (row["status"] == CONVERGED and row["second_order"] != "minimum" and
            f"second-order verdict {row['second_order'] or 'missing'}, expected minimum")


def miss_tunnel(row, _):
    return bool(row["crossings"]) and f"the wall is crossed between rows at {row['crossings']} places"


def miss_stationarity(row, bound):
    if row["status"] != CONVERGED:
        return False
    most = bound + (row["rounding_floor_N"] or 0.0)
    return row["stationarity_N"] > most and f"stationarity {row['stationarity_N']:.1e} N, expected at most {most:.1e}"


def miss_iterations(row, bound):
    return row["status"] == CONVERGED and row["iterations"] > bound and (
        f"{row['iterations']} iterations, expected at most {bound:g}")


# Expectations of one row: a function that says how it is missed, or something false. "peak" and "iteration-ratio" are
# of a family.
EXPECTATIONS = {"converged": miss_converged, "minimum": miss_minimum, "not-tunnelled": miss_tunnel,
                "stationarity": miss_stationarity, "iterations": miss_iterations, "peak": None, "iteration-ratio": None}
NEED_VALUE = ("stationarity", "iterations", "peak", "iteration-ratio")


def parse_expectations(texts):
    """{name: value} of 'name' or 'name=value'; ValueError with what was expected."""
    out = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if name not in EXPECTATIONS:
            raise ValueError(f"--expect {text}: unknown expectation '{name}'; expected one of: "
                             f"{', '.join(EXPECTATIONS)}")
        try:
            out[name] = float(value) if equals else None
        except ValueError:
            equals = ""
        if (name in NEED_VALUE) != bool(equals):
            raise ValueError(f"--expect {text}: expected '{name}{'=NUMBER' if name in NEED_VALUE else ''}'")
    return out


def judged_rows(rows):
    """A vessel that only bends has nothing to keep: it is measured and not judged."""
    return [row for row in ran(rows) if row["vessel"] == "full"]


def unmet(rows, expected=None):
    """[(expectation, solver, scene or family, how it is missed)]. `expected`: {name: value} for every grid instead of
    EXPECTED."""
    out = []
    judged = judged_rows(rows)
    for row in judged:
        for name, value in (EXPECTED[row["grid"]] if expected is None else expected).items():
            judge = EXPECTATIONS[name]
            text = judge(row, value) if judge else ""
            if text:
                out.append((name, row["solver"], row["scene"], text))
    for name, spread, what in (("peak", peak_differences(judged), "peak {:.4g} and {:.4g} mm on two meshes"),
                               ("iteration-ratio", iteration_ratios(judged), "{} to {} iterations over N")):
        for (solver, group), (first, second, amount) in spread.items():
            value = (EXPECTED[group[0]] if expected is None else expected).get(name)
            if value is not None and amount > value:
                out.append((name, solver, family_name(group),
                            what.format(first, second) + f": {amount:.3g}, expected at most {value:g}"))
    return sorted(out)


def family_name(group):
    grid, anatomy, kinematics, vessel, contact, start, bending, tension = group
    return f"{grid} {anatomy} {kinematics} {vessel} {contact} {start} EI {bending} T {tension:g}"
