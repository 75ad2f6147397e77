"""Runs a shipped study in its reduced form and gives its rows."""

import csv
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


def number(row, column):
    expect(row[column] != "", f"run {row['run']} has no {column}: {row['status']}, {row['reason']}")
    return float(row[column])


class StudyRun:
    """What the command left in a study's folder: the rows of results.csv, the documents."""

    def __init__(self, bowstring, name, folder):
        self.bowstring, self.folder = bowstring, pathlib.Path(folder)
        file = str(ROOT / "studies" / f"{name}.toml")
        self.command("study", file, "--reduced", "--out", folder, "--jobs", "1")
        self.command("study", file, "--reduced", "--out", folder, "--check")
        with open(self.folder / "results.csv", newline="", encoding="utf-8") as table:
            self.rows = list(csv.DictReader(table))

    def command(self, *arguments):
        done = subprocess.run([self.bowstring, *arguments], capture_output=True, text=True)
        expect(done.returncode == 0, f"bowstring {' '.join(arguments)}: exit code {done.returncode}\n{done.stderr}")
        return done.stdout

    def expect_runs(self, count):
        expect(len(self.rows) == count, f"{len(self.rows)} runs instead of {count}")
        expect(all(row["status"] for row in self.rows), "a run was not made")

    def pick(self, **choice):
        """The rows whose columns are as given; at least one."""
        found = [row for row in self.rows if all(same(row[column], value) for column, value in choice.items())]
        expect(found, f"no run with {choice}")
        return found

    def one(self, **choice):
        found = self.pick(**choice)
        expect(len(found) == 1, f"{len(found)} runs with {choice}")
        return found[0]

    def documents(self):
        files = sorted((self.folder / "runs").glob("*.result.json.gz"))
        return [json.loads(gzip.open(file, "rt", encoding="utf-8").read()) for file in files]


def same(cell, value):
    return cell == value if isinstance(value, str) else cell != "" and abs(float(cell) - value) <= 1e-9 * abs(value)


def run(name, test):
    """Runs the study with the command that the first argument names and hands it to `test`."""
    with tempfile.TemporaryDirectory() as folder:
        test(StudyRun(sys.argv[1], name, folder))
