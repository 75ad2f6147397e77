"""Solves grids of scenes with several solvers, records a row per run, and says what they show together: see README.md.

Exit codes: 0; 1 with --check where an expectation is not met or with --recheck where a document does not hold; 2 where
the input is wrong."""

import argparse
import os
import pathlib
import signal
import sys

import report
import results
import scenes
import summary
from runner import Runner, WrongInput, offered_solvers, recheck, say

NATIVE_SOLVERS = ("interior-point", "active-set")
REFERENCE_SOLVER = "ipopt"

DEFAULT_EVERY = {"A": 10}


def chosen_solvers(bowstring, asked):
    offered = offered_solvers(bowstring)
    if not asked:
        return [name for name in (*NATIVE_SOLVERS, REFERENCE_SOLVER) if name in offered]
    for name in asked:
        if name not in offered:
            raise WrongInput(f"--solver {name}: this bowstring has no such solver; expected one of: "
                             f"{', '.join(offered)} (`{bowstring} plugins solver` lists them)")
    return list(dict.fromkeys(asked))


def node_distances():
    """A function of two rows. Documents of the scene asked for last are kept."""
    kept = {}

    def positions(row):
        if row["result_file"] not in kept:
            kept[row["result_file"]] = (row["scene"], results.node_positions(results.read_json(row["result_file"])))
        return kept[row["result_file"]][1]

    def distance(first, second):
        for file in [file for file, (scene, _) in kept.items() if scene != first["scene"]]:
            del kept[file]
        return results.largest_distance(positions(first), positions(second))

    return distance


def choose_scenes(arguments):
    chosen = []
    for grid in arguments.grid or ["A"]:
        every = 1 if arguments.full else arguments.every or DEFAULT_EVERY.get(grid, 1)
        chosen += scenes.select(scenes.GRIDS[grid](arguments.full), every, arguments.nodes, arguments.match)
    if not chosen:
        raise WrongInput("no scene is chosen; expected --nodes and --match that some scene of --grid fits")
    return chosen


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0], allow_abbrev=False)
    parser.add_argument("bowstring", type=pathlib.Path, help="the built command")
    parser.add_argument("--solver", action="append", help="repeatable; default: every native one that is there, and "
                                                          + REFERENCE_SOLVER)
    parser.add_argument("--grid", action="append", choices=list(scenes.GRIDS), help="repeatable; default A")
    part = parser.add_mutually_exclusive_group()
    part.add_argument("--every", type=int, metavar="K",
                      help="every K-th scene; default: a tenth of A, all of the others")
    part.add_argument("--full", action="store_true", help="all scenes, and the longer mesh axis of C")
    parser.add_argument("--nodes", type=lambda text: {int(n) for n in text.split(",")}, metavar="N,N,…")
    parser.add_argument("--match", default="", metavar="TEXT", help="only scenes with this in their name")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="default: grid/ beside the command")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--time-limit", type=float, default=120.0, metavar="SECONDS")
    parser.add_argument("--fresh", action="store_true", help="solve again what is there")
    parser.add_argument("--markdown", type=pathlib.Path, metavar="FILE")
    parser.add_argument("--check", action="store_true", help="exit 1 where an expectation is not met")
    parser.add_argument("--expect", action="append", metavar="NAME[=VALUE]",
                        help="instead of summary.EXPECTED; repeatable: " + ", ".join(summary.EXPECTATIONS))
    parser.add_argument("--exempt", action="append", default=[], metavar="SOLVER", help="not judged by --check")
    parser.add_argument("--recheck", type=pathlib.Path, metavar="PROGRAM")
    parser.add_argument("--list", action="store_true", help="print the chosen scenes, and run nothing")
    asked = parser.parse_args(arguments)
    for name in ("jobs", "every", "time_limit"):
        value = getattr(asked, name)
        if value is not None and value <= 0:
            parser.error(f"--{name.replace('_', '-')} {value:g}: expected a positive number")
    return asked


def run(asked):
    chosen = choose_scenes(asked)
    if asked.list:
        print("\n".join(scene.name + (f"  ({scene.skip})" if scene.skip else "") for scene in chosen))
        return 0
    bowstring = asked.bowstring.absolute()
    solvers = chosen_solvers(bowstring, asked.solver)
    expected = summary.parse_expectations(asked.expect) if asked.expect else None
    if asked.recheck and not os.access(asked.recheck, os.X_OK):
        raise WrongInput(f"--recheck {asked.recheck}: expected an executable file")
    folder = (asked.out or bowstring.parent / "grid").absolute()
    folder.mkdir(parents=True, exist_ok=True)
    rows = Runner(bowstring, folder, asked.time_limit, asked.fresh).run_all(chosen, solvers, asked.jobs)
    results.write_csv(folder / "grid.csv", rows)
    subject = [row for row in rows if row["solver"] not in asked.exempt]
    missed = summary.unmet(subject, expected) if asked.check else None
    rechecked = recheck(str(asked.recheck.absolute()), rows) if asked.recheck else None
    judged = len(summary.judged_rows(subject))
    made = report.summarise(rows, REFERENCE_SOLVER, node_distances(), missed, judged, rechecked)
    (folder / "summary.txt").write_text(made.text())
    if asked.markdown:
        asked.markdown.write_text(made.text(markdown=True))
    print(made.text())
    return 1 if missed or (rechecked and rechecked[1]) else 0


def main(arguments):
    asked = parse(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # the processes are of other sessions: end them too
    try:
        return run(asked)
    except (WrongInput, ValueError) as error:
        say(f"grid: {error}")
        return 2
    except KeyboardInterrupt:
        say("grid: stopped; what is finished is kept")
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
