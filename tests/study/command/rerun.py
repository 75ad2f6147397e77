"""Every run of a study, cold or in a warm chain, gives the same bits when it is run again from its document alone; with a
plugin that was built anew it is refused, and the plugin named."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from study_command import Command, ExchangedLibrary, records, require, require_equal


def studies(command):
    axes = f"""
[axes]
T = {{ path = "energy.axial-tension.tension", values = ["1 N", "5 N", "20 N"] }}
contact = {{ path = "constraint.lumen.type", values = ["node-wise-contact", "segment-wise-contact"] }}
solver = {{ path = "solver.type", values = ["interior-point", "active-set"] }}
[set]
"vessel.iliac.geometry.nodes" = 40
"""
    opening = f'schema = 1\nbase = "{command.scene()}"\n'
    yield command.write("cold.toml", opening + axes)
    yield command.write("warm.toml", opening + 'warm-along = "T"\n' + axes)
    # Documents that hold a walk and a chain of states, on a small rod.
    yield command.write("procedures.toml", f"""schema = 1
[axes]
scene = {{ base = ["{command.scene('shallow-arch.toml')}", "{command.scene('wire-exchange.toml')}"] }}
""")


def rerun(command, document, *options, environment=None):
    done = subprocess.run([command.bowstring, "rerun", str(document), *options], cwd=command.folder, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **(environment or {})},
                          check=False)
    return done.returncode, done.stdout, done.stderr


def same_bits(command, out):
    count = warm = 0
    for record in records(out):
        read = json.loads(record.read_text())
        document = record.with_name(read["hash"] + ".result.json.gz")
        code, told, error = rerun(command, document)
        require_equal(code, 0 if read["status"] == "converged" else 1, f"{read['status']} {read['hash']}: {told}{error}")
        require("the same bits" in told, told)
        count += 1
        warm += read["predecessor"] is not None
    return count, warm


def refused_with_another_plugin(command, build, out):
    other = ExchangedLibrary(command, build, "active-set")
    other.exchange()
    refused = 0
    for record in records(out):
        document = record.with_name(record.name.replace(".json", ".result.json.gz"))
        code, told, error = rerun(other.command, document, environment=other.environment)
        require(code in (0, 2), f"{code}: {told}{error}")
        require((code == 2) == ("solver/active-set: sha256" in error), error)
        refused += code == 2
        if code == 2 and refused == 1:
            code, told, error = rerun(other.command, document, "--force", environment=other.environment)
            require_equal(code, 0, told + error)
    return refused


def main():
    bowstring, source_root, build = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as folder:
        command = Command(bowstring, source_root, folder)
        for study, expected in zip(studies(command), ((12, 0), (12, 8), (2, 0))):
            out = command.folder / study.stem
            code, _, error = command.run(study, out, "--jobs", "2")
            require_equal(code, 0, error)
            require_equal(same_bits(command, out), expected, study.name)
            print(f"{study.stem}: the same bits in {expected[0]} runs, {expected[1]} of them warm")
        require_equal(refused_with_another_plugin(command, pathlib.Path(build), command.folder / "cold"), 6, "refused")


if __name__ == "__main__":
    main()
