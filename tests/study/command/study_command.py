"""What the tests of `bowstring study` share: a small study, the command, its table."""

import csv
import json
import os
import pathlib
import shutil
import subprocess

SCENE = "planar-iliac-smooth.toml"


class Command:
    """The command of a build, run in a folder of its own."""

    def __init__(self, bowstring, source_root, folder):
        self.bowstring = str(pathlib.Path(bowstring).resolve())
        self.source_root, self.folder = pathlib.Path(source_root), pathlib.Path(folder)

    def scene(self, name=SCENE):
        return self.source_root / "scenes" / name

    def write(self, name, text):
        file = self.folder / name
        file.write_text(text)
        return file

    def arguments(self, study, out, *options):
        return [self.bowstring, "study", str(study), "--out", str(out), *options]

    def run(self, study, out, *options, environment=None, command=None, **more):
        done = subprocess.run(command or self.arguments(study, out, *options), cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                              env={**os.environ, **(environment or {})}, check=False, **more)
        return done.returncode, done.stdout, done.stderr

    def start(self, study, out, *options):
        return subprocess.Popen(self.arguments(study, out, *options), cwd=self.folder, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True)


class ExchangedLibrary:
    """A copy of the command with a list of plugins of its own, in which one library can be exchanged."""

    def __init__(self, command, build, plugin):
        self.place = command.folder / "exchanged"
        self.place.mkdir()
        copied = self.place / "bowstring"
        shutil.copy2(command.bowstring, copied)
        self.command = Command(copied, command.source_root, command.folder)
        libraries = os.pathsep.join(str(build / folder) for folder in ("core", "plugins/host"))
        self.environment = {"LD_LIBRARY_PATH": libraries}
        self.plugins, self.plugin = build / "plugins", plugin
        self.list_plugins(None)

    def list_plugins(self, changed):
        files = [str(changed) if changed is not None and file.name == changed.name else str(file)
                 for file in sorted(self.plugins.glob("*.bowstring.json"))]
        (self.place / "bowstring-plugins.json").write_text(json.dumps({"sidecars": files, "not_built": []}))

    def exchange(self):
        """The library gets one more byte, which changes nothing but its hash."""
        name = f"{self.plugin}.bowstring.json"
        sidecar = json.loads((self.plugins / name).read_text())
        library = self.plugins / sidecar["file"]
        (self.place / library.name).write_bytes(library.read_bytes() + b"\0")
        changed = self.place / name
        changed.write_text(json.dumps({**sidecar, "file": library.name}))
        self.list_plugins(changed)


def rows(folder):
    with open(pathlib.Path(folder) / "results.csv", newline="") as stream:
        return list(csv.DictReader(stream))


def figures(folder):
    """All that may not depend on where and when the runs were solved."""
    return [{key: value for key, value in row.items() if not key.endswith("_seconds")} for row in rows(folder)]


def records(folder):
    return sorted(file for file in (pathlib.Path(folder) / "runs").iterdir()
                  if file.name.endswith(".json"))


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def require_equal(found, expected, what):
    require(found == expected, f"{what}: found {found!r}, expected {expected!r}")
