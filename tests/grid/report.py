"""The summary of a grid as sections of text and tables, plain or Markdown."""

import statistics

import summary
from results import CONVERGED, NOT_RUN
from scenes import AXES

LISTED = 40  # rows of a table that lists single scenes; the CSV file has them all


class Report:
    """Collects sections; `text(markdown)` renders them."""

    def __init__(self):
        self.sections = []

    def section(self, title, headers, rows, note="", listed=None):
        rows = [[cell if isinstance(cell, str) else number(cell) for cell in row] for row in rows]
        if listed and len(rows) > listed:
            note = (note + f" The first {listed} of {len(rows)}.").strip()
            rows = rows[:listed]
        self.sections.append((title, headers, rows, note))

    def text(self, markdown=False):
        return "\n".join(render(*section, markdown) for section in self.sections)


def number(value):
    if value is None:
        return "–"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def render(title, headers, rows, note, markdown):
    lines = [f"## {title}", ""] if markdown else [title, "-" * len(title)]
    if note:
        lines += [note, ""]
    if rows and markdown:
        rows = [[cell.replace("|", "\\|") for cell in row] for row in rows]
        lines += ["| " + " | ".join(headers) + " |", "|" + "---|" * len(headers)]
        lines += ["| " + " | ".join(row) + " |" for row in rows]
    elif rows:
        widths = [max(len(row[column]) for row in [headers, *rows]) for column in range(len(headers))]
        lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in [headers, *rows]]
    elif not note:
        lines.append("none")
    return "\n".join(lines) + "\n"


def pivot(values, column_name):
    """Headers and rows of {(part, solver, nodes): text}: one row per part and solver, one column per N."""
    columns = sorted({nodes for _, _, nodes in values})
    keys = list(dict.fromkeys((part, solver) for part, solver, _ in values))
    headers = ["scenes", "solver", *(f"{column_name} {nodes}" for nodes in columns)]
    return headers, [[*key, *(values.get((*key, nodes), "–") for nodes in columns)] for key in keys]


def add_statuses(report, rows):
    counts = summary.status_counts(rows)
    statuses = sorted({status for counter in counts.values() for status in counter}, key=lambda s: (s != CONVERGED, s))
    report.section("Ends of the runs", ["grid", "solver", "runs", *statuses],
                   [[*key, sum(counter.values()), *(counter[status] for status in statuses)]
                    for key, counter in counts.items()])
    verdicts = summary.grouped(summary.converged(rows), "grid", "solver", "second_order")
    report.section("Second-order verdicts of what converged",
                   ["grid", "solver", "verdict", "scenes", "with weakly active rows"],
                   [[grid, solver, verdict, len(members), sum(row["weakly_active_count"] > 0 for row in members)]
                    for (grid, solver, verdict), members in verdicts.items()])


def add_failures(report, rows):
    failed = summary.failures(rows)
    kinds = {}
    for row in failed:
        kinds.setdefault((row["grid"], row["solver"], summary.kind_of_failure(row)), []).append(row)
    report.section("Failures by kind", ["grid", "solver", "kind", "scenes"],
                   [[*key, len(members)] for key, members in sorted(kinds.items(), key=lambda item: -len(item[1]))])
    report.section("Failures", ["solver", "grid", *AXES, "status", "iterations", "reason"],
                   [[row["solver"], row["grid"], *(row[axis] for axis in AXES), row["status"], row["iterations"],
                     (row["reason"] or "")[:160]] for row in failed], listed=LISTED)
    left_out = [row for row in rows if row["status"] in NOT_RUN]
    report.section("Left out", ["grid", "solver", "status", "scenes", "why, the first"],
                   [[*key, len(members), members[0]["reason"][:200]]
                    for key, members in summary.grouped(left_out, "grid", "solver", "status").items()])


def add_iterations(report, rows):
    for key in ("iterations", "epochs"):
        figures = {group: f"{median:g} / {most}"
                   for group, (_, median, most) in summary.figures_by_nodes(rows, key).items()}
        report.section(f"{key.capitalize()}, median / largest", *pivot(figures, "N"))
    grouped = {}
    for (solver, group), ratio in summary.iteration_ratios(rows).items():
        grouped.setdefault((group[0], solver), []).append((ratio[2], ratio, group))
    low, high = summary.RATIO_NODES
    report.section(f"Most over fewest iterations of a family, N = {low}…{high}",
                   ["grid", "solver", "families", "median", "largest", "where", "iterations"],
                   [[*key, len(members), statistics.median(member[0] for member in members), max(members)[0],
                     summary.family_name(max(members)[2]), f"{max(members)[1][0]}…{max(members)[1][1]}"]
                    for key, members in grouped.items()])


def add_times(report, rows, reference):
    figures = summary.figures_by_nodes(rows, "solve_s")
    headers, table = pivot({key: f"{1e3 * median:.3g}" for key, (_, median, _) in figures.items()}, "N")
    exponents = summary.time_exponents(rows)
    report.section("Solve time, median in ms, and its exponent in N", [*headers, "exponent"],
                   [[*row, exponents.get((row[0], row[1]))] for row in table])
    ratios = summary.ratios_to(rows, reference)
    if ratios:
        report.section(f"Solve time over that of {reference}, median over scenes that both solved",
                       *pivot({key: f"{median:.3g} ({count})" for key, (count, median) in ratios.items()}, "N"))


def add_agreement(report, rows, distance):
    pairs = summary.agreement(rows, distance)
    if not pairs:
        return
    table, different = [], []
    groups = {}
    for pair in pairs:
        groups.setdefault(pair[:2], []).append(pair)
    for solvers, members in groups.items():
        same = [pair for pair in members if pair[3] <= summary.SAME_BASIN]
        different += [pair for pair in members if pair[3] > summary.SAME_BASIN]
        table.append([*solvers, len(members), len(same), max((pair[3] for pair in same), default=None),
                      max((pair[4] for pair in same), default=None)])
    report.section("Agreement where both converged",
                   ["solver", "and", "scenes", "same basin", "largest relative energy difference",
                    "largest node distance, mm"],
                   table)
    report.section("Different basins", ["solver", "and", "scene", "relative energy difference", "node distance, mm"],
                   sorted(different, key=lambda pair: -pair[3]), listed=LISTED)


def add_grid_tables(report, rows):
    peaks = [(solver, group, figures) for (solver, group), figures in
             summary.peak_differences([row for row in rows if row["grid"] == "B"]).items()]
    if peaks:
        report.section("Grid B: peak displacement on two meshes",
                       ["solver", "scene", "coarse, mm", "fine, mm", "difference"],
                       [[solver, summary.family_name(group), *figures] for solver, group, figures in peaks])
    meshes = summary.families([row for row in summary.ran(rows) if row["grid"] == "C"])
    if meshes:
        columns = sorted({row["nodes"] for members in meshes.values() for row in members})
        table = []
        for (solver, group), members in meshes.items():
            cells = {row["nodes"]: str(row["iterations"]) if row["status"] == CONVERGED else row["status"]
                     for row in members}
            table.append([solver, *group[1:4], *(cells.get(nodes, "–") for nodes in columns)])
        report.section("Grid C: iterations",
                       ["solver", "anatomy", "kinematics", "vessel", *(f"N {n}" for n in columns)], table)
    warm = [row for row in summary.converged(rows) if row["grid"] == "W" and row["start"] != "first"]
    if warm:
        def spread(members, key):
            values = [row[key] for row in members if row[key] is not None]
            return f"{statistics.median(values):.4g} / {max(values):.4g}" if values else "–"
        report.section("Grid W: a load changed by 5 %, median / largest",
                       ["solver", "start", "scenes", "factorizations", "iterations", "solve, s"],
                       [[*key, len(members),
                         *(spread(members, what) for what in ("factorizations", "iterations", "solve_s"))]
                        for key, members in summary.grouped(warm, "solver", "start").items()])


def add_builds(report, rows):
    """Documents that are kept between calls may come from different builds of a solver."""
    for solver, members in summary.grouped(rows, "solver").items():
        builds = {row["solver_sha256"] for row in members} - {None}
        if len(builds) > 1:
            report.section("Warning", [], [],
                           f"The results of {solver} come from {len(builds)} builds of it: --fresh solves them again.")


def add_unmet(report, missed, judged):
    """`judged`: the number of runs that were judged."""
    kinds = {}
    for name, solver, _, _ in missed:
        kinds[name, solver] = kinds.get((name, solver), 0) + 1
    report.section("Expectations not met", ["expectation", "solver", "scenes"],
                   [[*key, count] for key, count in kinds.items()],
                   note=f"{judged} runs judged" + ("." if missed else ": all are met."))
    if missed:
        report.section("Expectations not met, one by one", ["expectation", "solver", "scene", "how"],
                       [[*miss[:3], miss[3][:160]] for miss in missed], listed=LISTED)


def summarise(rows, reference, distance, missed=None, judged=0, rechecked=None):
    """The whole report. `missed`: from summary.unmet, where expectations were asked for, and the number of runs
    `judged`; `rechecked`: (documents that hold, [[file, what was said]])."""
    report = Report()
    add_builds(report, rows)
    add_statuses(report, rows)
    add_failures(report, rows)
    add_iterations(report, rows)
    add_times(report, rows, reference)
    add_agreement(report, rows, distance)
    add_grid_tables(report, rows)
    if rechecked is not None:
        held, fallen = rechecked
        report.section("Re-check", ["file", "said"], fallen,
                       note=f"{held} documents hold, {len(fallen)} do not.", listed=LISTED)
    if missed is not None:
        add_unmet(report, missed, judged)
    return report
