"""A study that is killed, that meets a full disk or a folder it may not write, whose files are damaged, that two
commands solve at once, whose workers die: nothing is lost, nothing is half written, and the figures are the same."""

import hashlib
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import threading

from study_command import Command, ExchangedLibrary, figures, records, require, require_equal, rows

SHORT = "BOWSTRING_TEST_SHORT" in os.environ
KILLS, COUNT, NODES = (4, 4, 20) if SHORT else (20, 10, 60)
RUNS = 2 * COUNT * COUNT
SEED = 20


def kill_study(command):
    """200 runs, in warm chains."""
    return command.write("kill.toml", f"""
schema = 1
base = "{command.scene()}"
warm-along = "T"
quantities = ["quantities.peak_displacement_mm", {{ path = "contacts.force_N", reduce = "max" }}, "energy.total"]
[axes]
EI = {{ path = "energy.wire-bending.bending-stiffness", log = ["65 N mm^2", "6132 N mm^2"], count = {COUNT} }}
contact = {{ path = "constraint.lumen.type", values = ["node-wise-contact", "segment-wise-contact"] }}
T = {{ path = "energy.axial-tension.tension", linear = ["1 N", "10 N"], count = {COUNT} }}
[set]
"vessel.iliac.geometry.nodes" = {NODES}
""")


def wait_for_records(process, out, count):
    """Until the study has so many records, or has ended: no clock decides how far it gets."""
    while not ((out / "runs").is_dir() and len(records(out)) >= count):
        try:
            process.wait(timeout=0.002)
            return
        except subprocess.TimeoutExpired:
            pass


def small_study(command, name="small", more=""):
    return command.write(f"{name}.toml", f"""
schema = 1
base = "{command.scene()}"
[axes]
T = {{ path = "energy.axial-tension.tension", linear = ["1 N", "10 N"], count = 6 }}
{more}
[set]
"vessel.iliac.geometry.nodes" = 20
""")


def undisturbed(command, study, name, *options):
    out = command.folder / name
    code, _, error = command.run(study, out, *options)
    require_equal((code, error), (0, ""), f"{name} undisturbed")
    return out


def whole_or_absent(folder):
    """Every record that is there reads, at any moment."""
    for file in records(folder):
        try:
            json.loads(file.read_text())
        except FileNotFoundError:
            pass


def test_killed_at_random_moments(command):
    study = kill_study(command)
    calm = undisturbed(command, study, "calm", "--jobs", "2", "--keep", "summary")
    require_equal(len(rows(calm)), RUNS, "rows")
    out = command.folder / "killed"
    chance = random.Random(SEED)
    counts = []
    for _ in range(KILLS):
        process = command.start(study, out, "--jobs", "2", "--keep", "summary")
        threshold = (counts[-1] if counts else 0) + chance.randrange(1, RUNS // KILLS)
        wait_for_records(process, out, threshold)
        process.kill()
        process.communicate()
        whole_or_absent(out)
        counts.append(len(records(out)))
    require(0 < counts[0] < RUNS and sorted(counts) == counts, f"kills happen on the way: {counts}")
    print(f"records after each kill: {counts}")
    code, _, error = command.run(study, out, "--jobs", "2", "--keep", "summary")
    require_equal((code, error), (0, ""), "the rest")
    require_equal(figures(out), figures(calm), "figures after kills")
    require(not [name for name in os.listdir(out / "runs") if ".part-" in name], "temporary files stay")
    require_equal(command.run(study, out, "--check")[0], 0, "--check")


def test_jobs_and_shards_give_the_same_bits(command):
    study = kill_study(command)
    calm = figures(command.folder / "calm")
    alone = undisturbed(command, study, "alone", "--jobs", "1", "--keep", "summary")
    require_equal(figures(alone), calm, "one job")
    out = command.folder / "shards"
    for shard in ("1/3", "3/3", "2/3"):
        code, told, _ = command.run(study, out, "--jobs", "2", "--shard", shard, "--keep", "summary")
        require_equal(code, 0, shard)
        require("results.csv" in told, told)
    require_equal(figures(out), calm, "shards")


def test_two_commands_at_once(command):
    study = kill_study(command)
    out = command.folder / "both"
    first = command.start(study, out, "--jobs", "1", "--keep", "summary")
    second = command.start(study, out, "--jobs", "2", "--keep", "summary")
    ends = [first.communicate(), second.communicate()]
    require_equal((first.returncode, second.returncode), (0, 0), str(ends))
    require_equal(figures(out), figures(command.folder / "calm"), "two commands")


def test_interrupt(command):
    study = kill_study(command)
    out = command.folder / "interrupted"
    process = command.start(study, out, "--jobs", "2", "--keep", "summary")
    wait_for_records(process, out, 4)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate()
    require_equal(process.returncode, 1, error)
    require(f"of {RUNS} runs there; the same command goes on from here" in error, error)
    require(not (out / "results.csv").exists(), "a table of a part")


def test_workers_end_with_their_parent(command):
    """A killed command leaves nobody behind, for its output closes when the last of them is gone."""
    out = command.folder / "orphans"
    process = command.start(kill_study(command), out, "--jobs", "2", "--keep", "summary")
    wait_for_records(process, out, 1)
    process.kill()
    watchdog = threading.Timer(60.0, os._exit, [1])
    watchdog.start()
    process.communicate()
    watchdog.cancel()


def test_damaged_record(command):
    study = small_study(command)
    out = undisturbed(command, study, "damaged", "--jobs", "1")
    before = figures(out)
    victim = records(out)[2]
    whole = victim.read_text()
    for damage in (whole[:100], "", whole.replace('"status": "converged"', '"status": "stalled"'), whole + "x"):
        victim.write_text(damage)
        code, _, error = command.run(study, out, "--jobs", "1")
        require_equal(code, 2, f"damaged record {damage[:20]!r}")
        require(f"{victim}: the record of a run is damaged" in error.replace("//", "/"), error)
        require("remove it, and the same command solves that run again" in error, error)
        require_equal(victim.read_text(), damage, "the damaged record")
        code, told, error = command.run(study, out, "--check")
        require_equal(code, 1, told + error)
    victim.unlink()
    require_equal(command.run(study, out, "--jobs", "1")[0], 0, "mended")
    require_equal(figures(out), before, "figures after mending")


def test_damaged_document(command):
    study = small_study(command)
    out = command.folder / "damaged"
    document = next(file for file in (out / "runs").iterdir() if file.name.endswith(".result.json.gz"))
    whole = document.read_bytes()
    document.write_bytes(whole[:len(whole) // 2])
    code, _, error = command.run(study, out, "--check")
    require_equal(code, 1, error)
    require(f"{document}: the document of a run cannot be used (it ends too early" in error, error)
    document.write_bytes(whole)
    require_equal(command.run(study, out, "--check")[0], 0, "--check")


def failing_writes(command, library, error, after):
    return {"LD_PRELOAD": library, "BOWSTRING_TEST_WRITE_ERROR": error, "BOWSTRING_TEST_WRITES": str(after),
            "BOWSTRING_TEST_WRITE_FOLDER": str(command.folder)}


def test_full_disk(command, library):
    if library is None:
        return
    study = small_study(command)
    for after in (0, 1, 2, 3, 5, 8, 13):
        out = command.folder / f"full-{after}"
        code, _, error = command.run(study, out, "--jobs", "1",
                                     environment=failing_writes(command, library, "ENOSPC", after))
        require_equal(code, 2, error)
        require("No space left on device" in error and "cannot write" in error, error)
        code, _, error = command.run(study, out, "--jobs", "1")
        require_equal((code, error), (0, ""), "once there is room")
        require_equal(figures(out), figures(command.folder / "damaged"), "figures after a full disk")


def test_read_only_folder(command):
    study = small_study(command)
    out = undisturbed(command, study, "read-only", "--jobs", "1")
    before = sorted(os.listdir(out / "runs"))
    records(out)[0].unlink()
    with read_only(out) as works:
        if not works:
            return
        code, _, error = command.run(study, out, "--jobs", "1")
        require_equal(code, 2, error)
        require_equal(command.run(study, out, "--check")[0], 1, "--check writes nothing")
        require(f"cannot write in '{out}" in error and error.count("\n") >= 1, error)
    require_equal(len(os.listdir(out / "runs")), len(before) - 1, "files")
    require_equal(command.run(study, out, "--jobs", "1")[0], 0, "once it can be written")


class read_only:
    """A folder that even root cannot write: a mount of its own, or modes for everybody else."""

    def __init__(self, folder):
        self.folder, self.mounted, self.modes = folder, False, {}

    def __enter__(self):
        bind = ["mount", "--bind", str(self.folder), str(self.folder)]
        if os.geteuid() == 0:
            if subprocess.run(bind, stderr=subprocess.DEVNULL, check=False).returncode != 0:
                print("skipped: root, who may write everywhere, and no mounts")
                return False
            self.mounted = True
            done = subprocess.run(["mount", "-o", "remount,bind,ro", str(self.folder)], stderr=subprocess.DEVNULL, check=False)
            return done.returncode == 0
        for place in (self.folder / "runs", self.folder):
            self.modes[place] = place.stat().st_mode
            place.chmod(0o555)
        return True

    def __exit__(self, *_):
        if self.mounted:
            subprocess.run(["umount", str(self.folder)], check=True)
        for place, mode in self.modes.items():
            place.chmod(mode)


def test_workers_that_die(command, fixtures):
    study = command.write("leaving.toml", f"""
schema = 1
base = "leaving-scene.toml"
time-limit = "2 s"
[axes]
how = {{ path = "energy.test-leaving.how", values = ["stays", "exits", "crashes", "lingers"] }}
T = {{ path = "energy.axial-tension.tension", values = ["1 N", "2 N", "3 N"] }}
""")
    command.write("leaving-scene.toml", f"""
schema = 1
base = "{command.scene()}"
[[energy]]
type = "test-leaving"
on = "iliac"
""")
    out = command.folder / "leaving"
    code, told, error = command.run(study, out, "--jobs", "2", "--plugin-path", fixtures)
    require_equal(code, 0, told + error)
    by_how = {}
    for row in rows(out):
        by_how.setdefault(row["how"], set()).add((row["status"], row["reason"]))
    require_equal({status for status, _ in by_how["stays"]}, {"converged"}, "stays")
    twice = "the process that solved it ended with {}, twice"
    require_equal(by_how["exits"], {("failed", twice.format("exit status 0"))}, "exits")
    require_equal(by_how["crashes"], {("failed", twice.format("signal 9 (Killed)"))}, "crashes")
    require_equal(by_how["lingers"], {("failed", "it took longer than its time limit")}, "lingers")


def lingering_study(command, name, limit):
    """Two runs, of which one never ends by itself."""
    command.write(f"{name}-scene.toml", f"""
schema = 1
base = "{command.scene()}"
[[energy]]
type = "test-leaving"
on = "iliac"
""")
    return command.write(f"{name}.toml", f"""
schema = 1
base = "{name}-scene.toml"
{limit}
[axes]
how = {{ path = "energy.test-leaving.how", values = ["stays", "lingers"] }}
""")


def test_interrupt_of_a_run_that_does_not_come_back(command, fixtures):
    out = command.folder / "deaf"
    process = command.start(lingering_study(command, "deaf", ""), out, "--jobs", "2", "--plugin-path", fixtures)
    wait_for_records(process, out, 1)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate(timeout=120)
    require_equal(process.returncode, 1, error)
    require("stopped: 1 of 2 runs there" in error, error)


def wait_for_worker(process):
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
    while process.poll() is None and not children.read_text():
        pass


def test_interrupt_while_another_command_has_the_run(command, fixtures):
    study, out = lingering_study(command, "waiting", ""), command.folder / "waiting"
    options = ("--jobs", "1", "--plugin-path", fixtures)
    first = command.start(study, out, *options)
    wait_for_records(first, out, 1)
    second = command.start(study, out, *options)
    wait_for_worker(second)
    second.send_signal(signal.SIGINT)
    second.communicate(timeout=120)
    require_equal(second.returncode, 1, "the second command")
    require(first.poll() is None, "the first command goes on")
    first.kill()
    first.communicate()


def test_a_longer_time_limit_tries_again(command, fixtures):
    out, options = command.folder / "limit", ("--jobs", "1", "--plugin-path", fixtures)
    require_equal(command.run(lingering_study(command, "limit", 'time-limit = "0.5 s"'), out, *options)[0], 0, "short")
    ended = next(file for file in records(out) if json.loads(file.read_text())["status"] == "failed")
    require_equal(json.loads(ended.read_text())["time_limit"], 0.5, "the limit that ended it")
    stamp = ended.stat().st_mtime_ns
    require_equal(command.run(lingering_study(command, "limit", 'time-limit = "0.4 s"'), out, *options)[0], 0, "shorter")
    require_equal(ended.stat().st_mtime_ns, stamp, "a run that a longer limit has ended")
    require_equal(command.run(lingering_study(command, "limit", 'time-limit = "0.6 s"'), out, *options)[0], 0, "longer")
    require_equal(json.loads(ended.read_text())["time_limit"], 0.6, "the limit that ended it then")


def rewrite(record, **changes):
    """Another content of a record, with the digest that belongs to it."""
    body = record.read_text()
    body = body[:body.index(',\n "digest"')]
    text = json.dumps({**json.loads(body + "\n}"), **changes}, indent=1)
    text = text[:text.rindex("\n")]
    record.write_text(f'{text},\n "digest": "{hashlib.sha256(text.encode()).hexdigest()}"\n}}\n')


def test_chain_after_a_predecessor_that_failed(command):
    """Its successor starts from cold, says so, and is solved again when the predecessor converges after all."""
    study = command.write("chain.toml", f"""
schema = 1
base = "{command.scene()}"
warm-along = "T"
[axes]
T = {{ path = "energy.axial-tension.tension", values = ["1 N", "2 N", "3 N"] }}
[set]
"vessel.iliac.geometry.nodes" = 20
""")
    out = undisturbed(command, study, "chain", "--jobs", "1")
    before = figures(out)
    runs = [json.loads((out / "study.lock.json").read_text())["runs"][i]["hash"] for i in range(3)]
    files = [out / "runs" / f"{run}.json" for run in runs]
    whole = files[0].read_text()
    rewrite(files[0], status="failed", reason="a test", document_sha256=None, seconds={
        "load": 0.0, "setup": 0.0, "solve": [], "total": 0.0})
    files[1].unlink()
    require_equal(command.run(study, out, "--jobs", "1")[0], 0, "after a failed predecessor")
    require_equal(json.loads(files[1].read_text())["predecessor"], None, "it started from cold")
    require(figures(out) != before, "a start from cold leaves no trace")
    files[0].write_text(whole)
    require_equal(command.run(study, out, "--check")[0], 1, "--check")
    require_equal(command.run(study, out, "--jobs", "1")[0], 0, "after a predecessor that converged")
    require_equal(json.loads(files[1].read_text())["predecessor"], runs[0], "it started from its result")
    require_equal(figures(out), before, "figures")


def test_files_that_change_on_the_way(command, fixtures):
    """What is solved after that is no result of the study that was read."""
    study, out = lingering_study(command, "edited", 'time-limit = "2 s"'), command.folder / "edited"
    study.write_text(study.read_text().replace('"stays", "lingers"', '"lingers", "stays"'))
    process = command.start(study, out, "--jobs", "1", "--plugin-path", fixtures)
    wait_for_lock_file(process, out)
    scene = command.folder / "edited-scene.toml"
    scene.write_text(scene.read_text() + "stiffness = 1.0\n")
    _, error = process.communicate(timeout=120)
    require_equal(process.returncode, 2, error)
    require("files of the run how = " in error and "have changed since the study was read" in error, error)


def wait_for_lock_file(process, out):
    """Until the study has been read, which its lock file shows."""
    while process.poll() is None and not (out / "study.lock.json").exists():
        pass


def test_reasons_do_not_tell_the_folder(command):
    study = command.write("reasons.toml", f"""
schema = 1
base = "{command.scene()}"
[axes]
shape = {{ path = "vessel.iliac.geometry", values = [{{ type = "csv", file = "nowhere.csv" }}] }}
""")
    out = command.folder / "reasons"
    code, told, error = command.run(study, out, "--jobs", "1")
    require_equal(code, 0, told + error)
    require("nowhere.csv: cannot be read" in rows(out)[0]["reason"], str(rows(out)))
    require(str(command.folder) not in (out / "results.csv").read_text(), str(rows(out)))


def test_a_quantity_more_on_a_part_of_the_runs(command):
    """Runs that lack it are missing, and no table is written with holes."""
    out = command.folder / "more"
    undisturbed(command, small_study(command, "more"), "more", "--jobs", "1", "--keep", "summary")
    table = (out / "results.csv").read_text()
    study = small_study(command, "more")
    study.write_text(study.read_text().replace("[axes]", 'quantities = ["solver.iterations"]\n[axes]'))
    require_equal(command.run(study, out, "--check")[0], 1, "--check of records that lack a quantity")
    options = ("--jobs", "1", "--keep", "summary", "--shard")
    require_equal(command.run(study, out, *options, "1/2")[0], 0, "one part")
    require_equal((out / "results.csv").read_text(), table, "the table before the last part")
    require_equal(command.run(study, out, *options, "2/2")[0], 0, "the other part")
    with open(out / "results.csv", encoding="utf-8") as stream:
        require_equal(stream.readline().split(",").count("iterations"), 1, "columns of iterations")
    require(all(row["iterations"] for row in rows(out)), str(rows(out)))


def test_another_plugin_solves_again_what_names_it(command, build):
    study = small_study(command, "touched",
                        """solver = { path = "solver.type", values = ["interior-point", "active-set"] }""")
    out = command.folder / "touched"
    other = ExchangedLibrary(command, build, "active-set")

    def run():
        return other.command.run(study, out, "--jobs", "1", "--keep", "summary", environment=other.environment)

    require_equal(run()[0], 0, "first run")
    first = figures(out)
    before = set(records(out))
    require_equal(len(before), 12, "records")
    other.exchange()
    code, told, error = run()
    require_equal(code, 0, told + error)
    require_equal(len(set(records(out)) - before), 6, "records of the runs that name the exchanged library")
    require_equal(figures(out), first, "figures")


def main():
    bowstring, source_root, build, library = (sys.argv[1:] + [None])[:4]
    build = pathlib.Path(build).resolve()
    library = library and str(pathlib.Path(library).resolve())
    fixtures = str(build / "tests" / "plugins" / "fixtures")
    only = os.environ.get("BOWSTRING_TEST_ONLY", "")
    with tempfile.TemporaryDirectory() as folder:
        command = Command(bowstring, source_root, folder)
        tests = [
            (test_killed_at_random_moments, ()),
            (test_jobs_and_shards_give_the_same_bits, ()),
            (test_two_commands_at_once, ()),
            (test_interrupt, ()),
            (test_workers_end_with_their_parent, ()),
            (test_damaged_record, ()),
            (test_damaged_document, ()),
            (test_full_disk, (library,)),
            (test_read_only_folder, ()),
            (test_workers_that_die, (fixtures,)),
            (test_interrupt_of_a_run_that_does_not_come_back, (fixtures,)),
            (test_interrupt_while_another_command_has_the_run, (fixtures,)),
            (test_a_longer_time_limit_tries_again, (fixtures,)),
            (test_chain_after_a_predecessor_that_failed, ()),
            (test_files_that_change_on_the_way, (fixtures,)),
            (test_reasons_do_not_tell_the_folder, ()),
            (test_a_quantity_more_on_a_part_of_the_runs, ()),
            (test_another_plugin_solves_again_what_names_it, (build,)),
        ]
        for test, arguments in tests:
            if only in test.__name__:
                print(test.__name__, flush=True)
                test(command, *arguments)


if __name__ == "__main__":
    main()
