"""Takes subprojects/plugin-template away from this tree and lets a third party work on it, with nothing but an installed
bowstring: the commands of its README, its own tests, its compositions. Prints 'N passed, N failed'."""

import json
import pathlib
import re
import shutil
import sys
import tempfile

from install import Installation

COMPONENTS = (("energy", "superquadratic-anchoring"), ("constraint", "half-space"))


class Template(Installation):
    def prepare(self):
        """The project elsewhere, and the installed command on the path."""
        if not self.install():
            return False
        # pkg-config says the prefix that was configured; the stage stands elsewhere.
        text = self.package.read_text()
        self.package.write_text(re.sub(r"^prefix=.*$", f"prefix={self.prefix}", text, flags=re.MULTILINE))
        self.environment["PATH"] = f"{self.binary.parent}:{self.environment['PATH']}"
        project = self.folder / "my-plugins"
        shutil.copytree(self.source / "subprojects" / "plugin-template", project, ignore=shutil.ignore_patterns("build*"))
        self.work = project
        return True

    def readme(self):
        """Runs each command that the README shows, in its order; whether all end well."""
        blocks = re.findall(r"```sh\n(.*?)```", (self.work / "README.md").read_text(), re.DOTALL)
        commands = [line for block in blocks for line in block.splitlines() if line and not line.startswith("#")]
        self.check(len(commands) >= 3, "the README shows commands", commands)
        for command in commands:
            self.run("sh", "-c", command)
        return self.failed == 0

    def own_tests(self):
        log = self.work / "build" / "meson-logs" / "testlog.json"
        tests = [json.loads(line) for line in log.read_text().splitlines()]
        results = {test["name"]: test["result"] for test in tests}
        self.check(set(results) == {"superquadratic-anchoring", "half-space", "compositions"} and
                   set(results.values()) == {"OK"}, "every test of the template passes", results)

    def built_from_the_installation(self):
        commands = (self.work / "build" / "compile_commands.json").read_text()
        self.check(str(self.prefix) in commands, "it is compiled with the installed headers", commands)
        for folder in (self.source, self.build):
            self.check(f"{folder}/" not in commands, f"and without {folder}", commands)

    def components(self):
        for kind, name in COMPONENTS:
            told = self.run("bowstring", "describe", f"{kind}/{name}", "--plugin-path", "build")
            self.check(told.startswith(f"{kind}/{name}: "), f"describe {kind}/{name}", told)
        listed = {(entry["kind"], entry["name"]) for entry in json.loads(self.run("bowstring", "plugins", "--json"))}
        self.check(listed and not listed & set(COMPONENTS), "nothing of it is installed with bowstring", sorted(listed))

    def solve(self, scene, name):
        self.run("bowstring", "solve", f"scenes/{scene}.toml", "--plugin-path", "build", "--out", "result.json")
        result = json.loads((self.work / "result.json").read_text())
        files = [entry["file"] for entry in result["provenance"]["plugins"] if entry["name"] == name]
        self.check(files == [str(self.work / "build" / f"bowstring_{name}.so")], f"{scene} uses the plugin built here",
                   files)
        return result

    def figures(self):
        """The figures that the compositions give for themselves."""
        wire = self.solve("superquadratic-anchoring", "superquadratic-anchoring")["curves"][0]
        moved = wire["points"][-1][0] - wire["reference_points"][-1][0]
        self.check(abs(moved - 5.5) < 1e-6, "the wire moves by 5.5 mm", moved)
        plane = self.solve("half-space", "half-space")["state"]["multipliers"]["plane"]
        rod, vessel = plane[:100], plane[100:]
        self.check(abs(sum(rod) - 0.3) < 2e-4, "the plane takes 0.3 N of the rod's load", sum(rod))
        self.check(abs(sum(vessel) - 2.0) < 1e-6, "and moves the vessel with 2 N", sum(vessel))


def main(source, build):
    with tempfile.TemporaryDirectory() as folder:
        template = Template(source, build, folder)
        if template.prepare() and template.readme():
            template.own_tests()
            template.built_from_the_installation()
            template.figures()
            template.components()
    print(f"{template.passed} passed, {template.failed} failed")
    return 1 if template.failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
