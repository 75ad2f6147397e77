"""Solves grids of scenes with several solvers, records a row per run, and says what they show together: see README.md.

Exit codes: 0; 1 with --check where an expectation is not met or with --recheck where a document does not hold; 2 where
the input is wrong."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

import report
import results
import scenes
import summary

NATIVE_SOLVERS = ("interior-point", "active-set")
REFERENCE_SOLVER = "ipopt"

DEFAULT_EVERY = {"A": 10}
RECHECK_BATCH = 50


class WrongInput(Exception):
    pass


def say(text):
    print(text, file=sys.stderr, flush=True)


def offered_solvers(bowstring):
    try:
        told = subprocess.run([bowstring, "plugins", "solver", "--json"], stdout=subprocess.PIPE, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise WrongInput(f"'{bowstring} plugins solver' does not run: {error}") from error
    return [plugin["name"] for plugin in json.loads(told)]


def chosen_solvers(bowstring, asked):
    offered = offered_solvers(bowstring)
    if not asked:
        return [name for name in (*NATIVE_SOLVERS, REFERENCE_SOLVER) if name in offered]
    for name in asked:
        if name not in offered:
            raise WrongInput(f"--solver {name}: this bowstring has no such solver; expected one of: "
                             f"{', '.join(offered)} (`{bowstring} plugins solver` lists them)")
    return list(dict.fromkeys(asked))


def kill_after(time_limit):
    """Seconds that a process is given: a solver looks at its clock once an iteration only."""
    return 1.5 * time_limit + 20.0


class Runner:
    """Runs one process per scene and solver; each leaves FOLDER/runs/SOLVER/SCENE.json, unless it has no result, and
    SCENE.run.json: what was asked for and how the process went."""

    def __init__(self, bowstring, folder, time_limit, fresh):
        self.bowstring, self.folder, self.time_limit, self.fresh = bowstring, folder, time_limit, fresh
        self.lock = threading.Lock()
        self.processes = set()
        self.stopped = False

    def files(self, solver, name):
        place = self.folder / "runs" / solver / name
        return place.with_name(name + ".json"), place.with_name(name + ".run.json")

    def overrides(self, scene, solver):
        out = [*scene.overrides, ("solver.type", solver)]
        if scene.after:
            out.append(("start.from", str(self.files(solver, scene.after)[0])))
        return [list(pair) for pair in out]

    def kept(self, scene, solver):
        """Record and document of an earlier call that still answer the question, or None."""
        out, beside = self.files(solver, scene.name)
        record, document = results.read_json(beside), results.read_json(out)
        if self.fresh or not record or record["overrides"] != self.overrides(scene, solver):
            return None
        if record["killed"] or (document and document["status"] == "stalled"):
            return (record, document) if record["time_limit_s"] >= self.time_limit else None
        return (record, document) if document else None

    def run(self, scene, solver):
        """The row of one scene by one solver, and whether it was solved in this call."""
        out, beside = self.files(solver, scene.name)
        if scene.skip:
            return results.row_of(scene, solver, None, None, out), False
        kept = self.kept(scene, solver)
        solved = kept is None
        if solved:
            out.parent.mkdir(parents=True, exist_ok=True)
            out.unlink(missing_ok=True)
            beside.unlink(missing_ok=True)
            record = self.process(scene, solver, out)
            unfinished = beside.with_suffix(".part")
            unfinished.write_text(json.dumps(record, indent=1))
            unfinished.rename(beside)
            kept = record, results.read_json(out)
        return results.row_of(scene, solver, *kept, out), solved

    def process(self, scene, solver, out):
        overrides = self.overrides(scene, solver)
        command = [str(self.bowstring), "solve", str(scene.file), "--out", str(out)]
        for path, value in [*overrides, ("solver.time-limit", f"{self.time_limit:g}")]:
            command += ["--set", f"{path}={value}"]
        killed = threading.Event()
        with tempfile.TemporaryFile() as errors:
            begin = time.perf_counter()
            with self.lock:
                if self.stopped:
                    raise KeyboardInterrupt
                # A session of its own: an interrupt ends the runner, which then ends these.
                process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=errors, stdin=subprocess.DEVNULL,
                                           start_new_session=True)
                self.processes.add(process)

            def kill():
                killed.set()
                process.kill()

            timer = threading.Timer(kill_after(self.time_limit), kill)
            timer.start()
            _, state, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(state)
            timer.cancel()
            seconds = time.perf_counter() - begin
            with self.lock:
                self.processes.discard(process)
                if self.stopped:
                    raise KeyboardInterrupt
            errors.seek(0)
            said = errors.read().decode(errors="replace")[-4000:]
        return {"overrides": overrides, "time_limit_s": self.time_limit, "kill_after_s": kill_after(self.time_limit),
                "exit": process.returncode, "killed": killed.is_set(), "process_s": seconds,
                "cpu_s": usage.ru_utime + usage.ru_stime, "peak_memory_MB": usage.ru_maxrss / 1024.0, "stderr": said}

    def stop(self):
        with self.lock:
            self.stopped = True
            for process in self.processes:
                process.send_signal(signal.SIGKILL)

    def run_all(self, chosen, solvers, jobs):
        """Rows of all scenes by all solvers, in the order given. What a warm start is taken from has run before it."""
        rows = {}
        total, told = len(chosen) * len(solvers), 0
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            try:
                for warm in (False, True):
                    futures = {pool.submit(self.run, scene, solver): (scene.name, solver)
                               for scene in chosen if bool(scene.after) == warm for solver in solvers}
                    for future in concurrent.futures.as_completed(futures):
                        row, solved = future.result()
                        rows[futures[future]] = row
                        if solved:
                            told += 1
                            say(f"{len(rows)}/{total} {row['solver']} {row['scene']}: {row['status']}")
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                self.stop()
                raise
        if told < total:
            say(f"{total - told} of {total} results are kept from earlier calls, or left out")
        return [rows[scene.name, solver] for scene in chosen for solver in solvers]


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


def recheck(program, rows):
    """(documents that hold, [[file, what was said]]) by a program that takes documents and exits 0 if each holds."""
    files = [row["result_file"] for row in rows if row["result_file"]]
    fallen = []

    def call(batch):
        return subprocess.run([program, *batch], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)

    for begin in range(0, len(files), RECHECK_BATCH):
        batch = files[begin:begin + RECHECK_BATCH]
        if call(batch).returncode == 0:
            continue
        for file in batch:  # which of them
            done = call([file])
            if done.returncode != 0:
                said = " ".join(done.stdout.decode(errors="replace").split())
                fallen.append([os.path.join(*pathlib.Path(file).parts[-2:]), f"exit {done.returncode}: {said}"[:240]])
    return len(files) - len(fallen), fallen


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
