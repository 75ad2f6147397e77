"""One process per scene and solver, several at a time; and the re-check of what they wrote."""

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

import results

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


def kill_after(time_limit):
    """Seconds that a process is given: a solver looks at its clock once an iteration only."""
    return 1.5 * time_limit + 20.0


class Runner:
    """Runs one process per scene and solver, of anything with `name`, `file`, `overrides`, `after` and `skip`. `row_of`
    makes a row of (scene, solver, record, document, file of the document). Each run leaves FOLDER/runs/SOLVER/SCENE.json, unless it has no result, and
    SCENE.run.json: what was asked for and how the process went."""

    def __init__(self, bowstring, folder, time_limit, fresh, row_of=results.row_of):
        self.bowstring, self.folder, self.time_limit, self.fresh = bowstring, folder, time_limit, fresh
        self.row_of = row_of
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
            return self.row_of(scene, solver, None, None, out), False
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
        return self.row_of(scene, solver, *kept, out), solved

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
