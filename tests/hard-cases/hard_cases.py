"""Runs hard cases and judges every result by the verdict that is true of its scene: see README.md.

Exit codes: 0; 1 where an expectation is not met, a known shortfall is none any longer, or a `converged` does not stand
up to the re-check; 2 where the input is wrong; 77 where every case needs data that is not there."""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import shutil
import signal
import sys

import cases
import grid
import results

SKIPPED = 77
SHORT = "BOWSTRING_TEST_SHORT"


class Tally:
    def __init__(self):
        self.passed, self.failed, self.skipped, self.shortfalls = 0, 0, 0, 0

    def check(self, good, text):
        print(f"  {'pass' if good else 'FAIL'}  {text}", flush=True)
        if good:
            self.passed += 1
        else:
            self.failed += 1


def brief(row):
    if row["status"] in (*results.NO_DOCUMENT, *results.NOT_RUN):
        return row["status"]
    return f"{row['status']} in {row['iterations']} iterations, {row['solve_s']:.3g} s"


def judge(run, row, document, tally, demanded):
    """Counts one result. A solver that is not demanded is shown only."""
    where = f"{run.name}, {row['solver']}: {brief(row)}"
    found = cases.faults(run, row, document)
    if not demanded:
        print(f"  shown {where}{'; ' + '; '.join(found) if found else ''}", flush=True)
    elif row["solver"] in run.shortfalls:
        if found:
            tally.shortfalls += 1
            print(f"  known {where}; {'; '.join(found)}; known: {run.shortfalls[row['solver']]}", flush=True)
        else:
            tally.check(False, f"{where}: is as expected, though marked as a known shortfall "
                               f"({run.shortfalls[row['solver']]}); take the mark away")
    else:
        tally.check(not found, f"{where}{'; ' + '; '.join(found) if found else ''}")


def shortened(runs):
    """The first run of each entry, for builds that are slow."""
    return [run for run in runs if run.first]


def solve(runner, case, solver, full):
    """[(run, row, document)] of one case by one solver; runs that only the full test has are left out."""
    out = []
    for run in shortened(case.runs) if SHORT in os.environ else case.runs:
        if run.full and not full:
            continue
        row, _ = runner.run(run.scene, solver)
        out.append((run, row, results.read_json(row["result_file"]) if row["result_file"] else None))
    return out


def demanded(solver):
    return solver in cases.NATIVE_SOLVERS


def judge_case(case, solver, solved, tally, recheck):
    for run, row, document in solved:
        judge(run, row, document, tally, demanded(solver))
    documents = {run.name: document for run, row, document in solved
                 if row["status"] == run.verdicts[0] and solver not in run.shortfalls}
    for agreement in case.agreements if demanded(solver) else ():
        wrong = cases.disagreement(agreement, documents)
        if wrong is None:
            tally.skipped += 1
        else:
            tally.check(not wrong, f"{solver}: {wrong or agreement['path'] + ' agrees'}")
    return recheck_all(solver, solved, tally, recheck) if recheck else set()


def recheck_all(solver, solved, tally, recheck):
    """Every `converged` is re-checked, and those that are marked must not hold. Names of the runs that do not."""
    denied = set()
    found = [(run, row) for run, row, _ in solved if row["status"] == results.CONVERGED]
    plain = [(run, row) for run, row in found if solver not in run.recheck_shortfalls]
    if plain:
        held, fallen = grid.recheck(recheck, [row for _, row in plain])
        files = {file for file, _ in fallen}
        denied |= {run.name for run, row in plain
                   if os.path.join(*pathlib.Path(row["result_file"]).parts[-2:]) in files}
        tally.check(not fallen, f"{solver}: {held} of {len(plain)} `converged` stand up to the re-check"
                                + "".join(f"; {file}: {said}" for file, said in fallen))
    for run, row in found:
        if solver not in run.recheck_shortfalls:
            continue
        known = run.recheck_shortfalls[solver]
        if grid.recheck(recheck, [row])[0]:
            tally.check(False, f"{run.name}, {solver}: stands up to the re-check, though marked as a known shortfall "
                               f"({known}); take the mark away")
        else:
            tally.shortfalls += 1
            denied.add(run.name)
            print(f"  known {run.name}, {solver}: the re-check does not take it for an equilibrium; known: {known}",
                  flush=True)
    return denied


def verdict_cell(run, row, document, denied):
    if row["status"] in results.NO_DOCUMENT:
        return row["status"] + ("" if row["status"] in run.verdicts else " ✗")
    order = {"saddle": ", saddle", "degenerate": ", degenerate"}.get(row["second_order"], "")
    mark = " ✗" if cases.faults(run, row, document) else " †" if denied else ""
    return f"{row['status']}{order}, {row['iterations']}, {row['solve_s']:.2g}{mark}"


def markdown(solved_by_case, solvers, denied):
    """A table per case: verdict, iterations, seconds; ✗ where a verdict or a figure is not what is true, † where the
    re-check denies a `converged`. `denied`: {(case, solver): names of runs}."""
    lines = []
    for case, by_solver in solved_by_case:
        lines += [f"### {case.name}", "", case.why, "",
                  "| run | true | " + " | ".join(solvers) + " |", "|---|---|" + "---|" * len(solvers)]
        if case.skip:
            lines += [f"| all | skipped: {case.skip} |" + " |" * len(solvers), ""]
            continue
        rows = zip(*(by_solver[solver] for solver in solvers))
        for entries in rows:
            run = entries[0][0]
            cells = [verdict_cell(run, row, document, run.name in denied[case.name, solver])
                     for solver, (_, row, document) in zip(solvers, entries)]
            lines.append(f"| {run.name} | {' or '.join(run.verdicts)} | " + " | ".join(cells) + " |")
        lines.append("")
    return "\n".join(lines)


def totals(solved_by_case, solvers, denied):
    """Counts per solver: runs whose verdict and figures are true, the others, and of the first those that the re-check
    denies."""
    lines = ["| solver | runs | as is true | not (✗) | denied by the re-check (†) | median iterations of `converged` |",
             "|---|---|---|---|---|---|"]
    for solver in solvers:
        judged = [(run, row, document) for _, by_solver in solved_by_case for run, row, document in by_solver[solver]
                  if row["status"] not in results.NOT_RUN]
        good = sum(not cases.faults(*entry) for entry in judged)
        doubted = sum(len(names) for (_, of), names in denied.items() if of == solver)
        counts = sorted(row["iterations"] for _, row, _ in judged if row["status"] == results.CONVERGED)
        middle = counts[len(counts) // 2] if counts else "–"
        lines.append(f"| {solver} | {len(judged)} | {good} | {len(judged) - good} | {doubted} | {middle} |")
    return "\n".join(lines)


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0], allow_abbrev=False)
    parser.add_argument("bowstring", type=pathlib.Path, help="the built command")
    parser.add_argument("case", nargs="*", type=pathlib.Path, help="default: all beside this program")
    parser.add_argument("--solver", action="append", help="repeatable; default: the native ones; others are shown only")
    parser.add_argument("--match", default="", metavar="TEXT", help="only runs with this in their name")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="default: hard-cases/ beside the command")
    parser.add_argument("--recheck", type=pathlib.Path, metavar="PROGRAM")
    parser.add_argument("--markdown", type=pathlib.Path, metavar="FILE", help="write the tables of docs/hard-cases.md")
    parser.add_argument("--time-limit", type=float, default=300.0, metavar="SECONDS")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--keep", action="store_true", help="do not solve again what DIR already holds")
    parser.add_argument("--full", action="store_true", default="BOWSTRING_TEST_FULL" in os.environ,
                        help="the large runs too (BOWSTRING_TEST_FULL)")
    return parser.parse_args(arguments)


def run(asked):
    bowstring = asked.bowstring.absolute()
    folder = (asked.out or bowstring.parent / "hard-cases").absolute()
    if not asked.keep:
        shutil.rmtree(folder, ignore_errors=True)
    files = asked.case or sorted(cases.HERE.glob("*.toml"))
    solvers = grid.chosen_solvers(bowstring, asked.solver or list(cases.NATIVE_SOLVERS))
    chosen = [cases.Reader(folder / "compositions").case(file) for file in files]
    if asked.match:
        chosen = [cases.dataclasses.replace(case, runs=tuple(r for r in case.runs if asked.match in r.name),
                                            agreements=()) for case in chosen]
    recheck = str(asked.recheck.absolute()) if asked.recheck else None
    runner = grid.Runner(bowstring, folder, asked.time_limit, not asked.keep)
    tally, solved_by_case, denied = Tally(), [], collections.defaultdict(set)
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        try:
            futures = [(case, {solver: pool.submit(solve, runner, case, solver, asked.full) for solver in solvers})
                       for case in chosen]
            for case, by_solver in futures:
                print(f"{case.name}: {case.why}", flush=True)
                solved = {solver: future.result() for solver, future in by_solver.items()}
                solved_by_case.append((case, solved))
                if case.skip:
                    print(f"  skipped: {case.skip}")
                    tally.skipped += 1
                    continue
                for solver in solvers:
                    denied[case.name, solver] = judge_case(case, solver, solved[solver], tally, recheck)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            runner.stop()
            raise
    if asked.markdown:
        asked.markdown.write_text(totals(solved_by_case, solvers, denied) + "\n\n"
                                  + markdown(solved_by_case, solvers, denied))
    print(f"{tally.passed} passed, {tally.failed} failed, {tally.skipped} skipped"
          + (f", {tally.shortfalls} known shortfalls" if tally.shortfalls else ""))
    if tally.failed:
        return 1
    return 0 if tally.passed or tally.shortfalls else SKIPPED


def main(arguments):
    asked = parse(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # the processes are of other sessions: end them too
    try:
        return run(asked)
    except (grid.WrongInput, cases.WrongCase, ValueError) as error:
        print(f"hard-cases: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
