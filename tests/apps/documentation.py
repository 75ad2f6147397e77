"""Runs what the documentation tells a reader to run.

Every ```sh block of README.md and docs/*.md is executed with this build's `bowstring`, in a folder that holds copies of
scenes/, studies/ and subprojects/; every ```toml block that is a composition is explained; the ```cpp block is compiled against an
installed prefix; docs/parameters.md must be what the plugins declare. A block's first lines may say: '# exit N',
'# file: NAME', '# needs …'. Prints 'N passed, N failed'."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

OTHERWISE_TESTED = ("./dev demo", "./dev test")  # by whoever runs this


class Documents:
    def __init__(self, bowstring, source, build, folder):
        self.bowstring, self.source, self.build = pathlib.Path(bowstring).resolve(), pathlib.Path(source).resolve(), build
        self.folder = pathlib.Path(folder)
        self.passed = self.failed = 0
        for name in ("scenes", "studies"):
            shutil.copytree(self.source / name, self.folder / name)
        shutil.copytree(self.source / "subprojects", self.folder / "subprojects", ignore=shutil.ignore_patterns("build*"))
        binaries = self.folder / "bin"
        binaries.mkdir()
        (binaries / "bowstring").symlink_to(self.bowstring)
        (self.folder / "build").mkdir()
        (self.folder / "build" / "bowstring").symlink_to(self.bowstring)
        self.environment = {**os.environ, "PATH": f"{binaries}:{os.environ['PATH']}"}

    def check(self, good, what, details=""):
        self.passed += good
        self.failed += not good
        if not good:
            print(f"FAIL  {what}\n{details}")

    def run(self, command, code=0):
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False)
        self.check(done.returncode == code, command, f"exit {done.returncode}, expected {code}\n{done.stdout}")
        return done.stdout

    def install(self):
        prefix = self.folder / "prefix"
        installed = subprocess.run(["meson", "install", "-C", self.build, "--no-rebuild", "--quiet", "--destdir", prefix],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.check(installed.returncode == 0, "meson install", installed.stdout)
        found = list(prefix.rglob("bowstring.pc"))
        self.check(len(found) == 1, "the pkg-config file is installed", str(found))
        # A staged prefix is moved from where it was configured to be.
        wrapper = self.folder / "bin" / "pkg-config"
        root = next(prefix.rglob("bin/bowstring")).parent.parent
        wrapper.write_text(f'#!/bin/sh\nexec {shutil.which("pkg-config")} --define-variable=prefix={root} "$@"\n')
        wrapper.chmod(0o755)
        self.environment["PKG_CONFIG_PATH"] = str(found[0].parent)
        libraries = next(prefix.rglob("libbowstring.so")).parent
        self.environment["LD_LIBRARY_PATH"] = str(libraries)
        binary = root / "bin" / "bowstring"
        plugins = self.run(f"{binary} plugins solver")
        self.check("ipopt" in plugins, "an installed bowstring finds the installed plugins", plugins)
        self.run(f"{binary} solve scenes/planar-iliac-smooth.toml --out installed.json")

    def blocks(self, page):
        for kind, text in re.findall(r"```(\w+)\n(.*?)```", page.read_text(), re.DOTALL):
            marks = re.findall(r"^(?:#|//) (exit|file:|needs) ?(.*)$", text, re.MULTILINE)
            yield kind, text, dict(marks)

    def page(self, page):
        last_output = ""
        for kind, text, marks in self.blocks(page):
            if kind == "sh":
                for command in (line for line in text.splitlines() if line and not line.startswith("#")):
                    if not command.startswith(OTHERWISE_TESTED):
                        last_output = self.run(command, int(marks.get("exit", 0)))
            elif kind == "text":
                self.check(text == last_output, f"{page.name}: the output shown", f"{text}\nis not\n{last_output}")
            elif kind == "cpp" and "file:" in marks:
                (self.folder / marks["file:"]).write_text(text)
            elif kind == "toml" and "schema = 1" in text:
                name = marks.get("file:", "documented.toml")
                (self.folder / name).write_text(text)
                if "[axes]" not in text:  # a study is not explained, but run by the block that follows it
                    self.run(f"bowstring explain {name}")

    def parameters(self):
        made = self.run(f"{sys.executable} {self.source}/docs/make_parameters.py {self.bowstring}")
        self.check(made == (self.source / "docs" / "parameters.md").read_text(), "docs/parameters.md is up to date",
                   "python3 docs/make_parameters.py build/bowstring > docs/parameters.md")
        formulations = (self.source / "docs" / "formulations.md").read_text()
        headings = " ".join(line for line in formulations.splitlines() if line.startswith("## "))
        for plugin in re.findall(r"^## \S+/(\S+)$", made, re.MULTILINE):
            self.check(re.search(rf"[/ ]{re.escape(plugin)}\b", headings) is not None, f"formulations.md has {plugin}")


def main(bowstring, source, build):
    with tempfile.TemporaryDirectory() as folder:
        documents = Documents(bowstring, source, build, folder)
        documents.install()
        documents.parameters()
        for page in [documents.source / "README.md", *sorted((documents.source / "docs").glob("*.md"))]:
            documents.page(page)
    print(f"{documents.passed} passed, {documents.failed} failed")
    return 1 if documents.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
