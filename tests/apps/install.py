"""Installs this build into an empty folder and uses it from there, as a package would be: the command, the headers of
the plugin contract, every plugin with its sidecar, and what pkg-config says. Prints 'N passed, N failed'."""

import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

PROGRAM = """#include <cstdio>
#include "core/interfaces/component.hpp"
#include "plugins/sdk/abi_tag.hpp"
int main() { std::printf("%s %s", bowstring::kind_name(bowstring::Kind::energy), bowstring::make_abi_tag().text); }
"""
HOST_PROGRAM = """#include <cstdio>
#include "plugins/host/plugin_host.hpp"
int main(int, char** folder) {
  bowstring::PluginHost host({{folder[1]}, {}, "", ""});
  bowstring::Status status;
  const bool found = host.find(bowstring::Kind::energy, "wire-bending", status) != nullptr;
  std::printf("%s", found ? "found" : status.text.c_str());
}
"""


def settings():
    """The environment without what would lead an installed command back to the build."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("BOWSTRING_")}
    for name in ("LD_LIBRARY_PATH", "LIBRARY_PATH", "CPATH", "CPLUS_INCLUDE_PATH", "PKG_CONFIG_PATH"):
        kept.pop(name, None)
    return kept


class Installation:
    def __init__(self, source, build, folder):
        self.source, self.build = pathlib.Path(source).resolve(), pathlib.Path(build).resolve()
        self.folder = pathlib.Path(folder).resolve()
        self.stage, self.work = self.folder / "stage", self.folder / "work"
        self.work.mkdir()
        self.environment = settings()
        self.passed = self.failed = 0

    def check(self, good, what, details=""):
        self.passed += bool(good)
        self.failed += not good
        if not good:
            print(f"FAIL  {what}\n{details}")
        return bool(good)

    def run(self, *command):
        """What the command prints; counts as a check that it ends well."""
        done = subprocess.run([str(part) for part in command], cwd=self.work, env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        self.check(done.returncode == 0, shlex.join(str(part) for part in command),
                   f"exit {done.returncode}\n{done.stdout}")
        return done.stdout

    def only(self, pattern):
        """The one installed file of this name, or nothing."""
        found = list(self.stage.rglob(pattern))
        self.check(len(found) == 1, f"one installed {pattern}", str(found))
        return found[0] if len(found) == 1 else None

    def install(self):
        self.run("meson", "install", "-C", self.build, "--no-rebuild", "--quiet", "--destdir", self.stage)
        binary, self.package = self.only("bin/bowstring"), self.only("bowstring.pc")
        if binary is None or self.package is None:
            return False
        self.prefix, self.binary = binary.parent.parent, binary
        # The stage stands elsewhere than the prefix that was configured.
        self.environment["PKG_CONFIG_PATH"] = str(self.package.parent)
        return True

    def ask_pkg_config(self, *arguments):
        return self.run("pkg-config", f"--define-variable=prefix={self.prefix}", *arguments).strip()

    def headers(self):
        include = self.prefix / "include" / "bowstring"
        installed = {str(file.relative_to(include)) for file in include.rglob("*.hpp")}
        for folder in ("core/interfaces", "plugins/sdk"):
            expected = {str(file.relative_to(self.source)) for file in (self.source / folder).glob("*.hpp")}
            self.check(expected and expected <= installed, f"headers of {folder}", sorted(expected - installed))
            for header in sorted(expected & installed):
                (self.work / "header.cpp").write_text(f'#include "{header}"\n')
                self.run("c++", "-std=c++17", "-fsyntax-only", f"-I{include}", "header.cpp")

    def plugins(self):
        folder = pathlib.Path(self.ask_pkg_config("--variable=plugindir", "bowstring"))
        libraries = {file.name for file in folder.glob("*.so")}
        described = {}
        for sidecar in folder.glob("*.bowstring.json"):
            content = json.loads(sidecar.read_text())
            for component in content["components"]:
                described[component["kind"], component["name"]] = content["file"]
        self.check(libraries and libraries == set(described.values()), "a sidecar beside every plugin",
                   f"libraries {sorted(libraries)}\nsidecars {described}")
        listed = {(entry["kind"], entry["name"]) for entry in json.loads(self.run(self.binary, "plugins", "--json"))}
        built = json.loads(self.run(self.build / "bowstring", "plugins", "--json"))
        self.check(listed == {(entry["kind"], entry["name"]) for entry in built},
                   "the installed command lists the plugins of this build", sorted(listed))
        self.check(set(described) == listed, "and no others than the sidecars name", sorted(set(described) ^ listed))

    def solve(self):
        shutil.copytree(self.source / "scenes", self.work / "scenes")
        self.run(self.binary, "solve", "scenes/planar-iliac-smooth.toml", "--out", "result.json")
        result = json.loads((self.work / "result.json").read_text())
        self.check(result["status"] == "converged", "the installed command solves a scene", result["reason"])
        files = [plugin["file"] for plugin in result["provenance"]["plugins"]]
        self.check(files and all(pathlib.Path(file).is_relative_to(self.prefix) for file in files),
                   "with the installed plugins", files)
        resolved = self.run("ldd", self.binary)
        ours = re.findall(r"libbowstring\S* => (\S+)", resolved)
        self.check(ours and all(pathlib.Path(file).resolve().is_relative_to(self.prefix) for file in ours),
                   "and the installed libraries, found without any setting", resolved)

    def compile(self, name, text, package, standard):
        (self.work / f"{name}.cpp").write_text(text)
        flags = shlex.split(self.ask_pkg_config("--cflags", "--libs", package))
        library_folder = self.ask_pkg_config("--variable=libdir", "bowstring")
        self.run("c++", standard, "-Wall", "-Wextra", "-Werror", f"{name}.cpp", "-o", name, *flags,
                 f"-Wl,-rpath,{library_folder}")

    def programs(self):
        self.compile("program", PROGRAM, "bowstring", "-std=c++17")
        tag = self.ask_pkg_config("--variable=abi_tag", "bowstring")
        told = self.run("./program")
        self.check(told == f"energy {tag}", "a program links against the installed library", told)
        self.compile("host", HOST_PROGRAM, "bowstring-host", "-std=c++17")
        told = self.run("./host", self.ask_pkg_config("--variable=plugindir", "bowstring"))
        self.check(told == "found", "a program opens the installed plugins", told)

    def in_process(self):
        """The program of docs/in-process.md, with nothing but what pkg-config says."""
        page = (self.source / "docs" / "in-process.md").read_text()
        sweep = re.search(r"```cpp\n(// file: sweep\.cpp.*?)```", page, re.DOTALL)
        if not self.check(sweep, "docs/in-process.md has a program"):
            return
        self.compile("sweep", sweep[1], "bowstring-host", "-std=c++17")
        rows = [line.split(",") for line in self.run("./sweep", "scenes/planar-iliac-smooth.toml").splitlines()]
        self.check(rows[0] == ["tension_N", "peak_displacement_mm", "contact_force_N"], "its header", rows[0])
        peaks = [float(row[1]) for row in rows[1:]]
        self.check([row[0] for row in rows[1:]] == [str(tension) for tension in range(1, 21)] and peaks == sorted(set(peaks))
                   and peaks[0] > 1.0, "the vessel moves further for every N", rows)
        peak = json.loads((self.work / "result.json").read_text())["quantities"]["peak_displacement_mm"]
        self.check(rows[10][1] == f"{peak:.3f}", "as the command says for 10 N", f"{rows[10]}, {peak}")
        needed = self.run("c++", "-std=c++17", "-M", *shlex.split(self.ask_pkg_config("--cflags", "bowstring-host")), "sweep.cpp")
        self.check("simulation.hpp" in needed and not re.search(r"Eigen|nlohmann|toml\+\+|boost", needed),
                   "the public headers need no other library", needed)


def main(source, build):
    with tempfile.TemporaryDirectory() as folder:
        installation = Installation(source, build, folder)
        if installation.install():
            installation.headers()
            installation.plugins()
            installation.solve()
            installation.programs()
            installation.in_process()
    print(f"{installation.passed} passed, {installation.failed} failed")
    return 1 if installation.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
