"""Builds one fuzz target by clang with libFuzzer and address sanitizer, and lets it look for inputs that break it.

Arguments: target, source root, build folder, folders of inputs to start from. Runs in the full test only
(BOWSTRING_TEST_FULL); BOWSTRING_FUZZ_SECONDS is how long, default 300. Skips, with the reason, where it cannot run. What
it finds fails the test and stays in the build folder; once mended, such an input belongs into the target's corpus."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77
SECONDS = 300
FLAGS = ["-std=c++20", "-O1", "-g", "-fno-omit-frame-pointer", "-fsanitize=fuzzer,address,undefined",
         "-fno-sanitize-recover=undefined"]
LIBRARIES = ["-ludunits2"]
READING = ["core/composition/*.cpp", "core/measure/*.cpp", "core/curve/arc_length.cpp", "core/curve/csv_cells.cpp",
           "core/transport/check_measure.cpp", "core/interfaces/interfaces.cpp", "tests/fuzz/scratch.cpp"]
SOURCES = {
    "composition": [*READING, "tests/composition/fake_registry.cpp", "tests/fuzz/composition.cpp"],
    "measure": [*READING, "tests/fuzz/measure.cpp"],
    "point-table": ["core/curve/point_table.cpp", "core/curve/csv_cells.cpp", "tests/fuzz/point_table.cpp",
                    "tests/fuzz/scratch.cpp"],
}


def skip(reason):
    print(f"skipped: {reason}", flush=True)
    sys.exit(SKIPPED)


def find_compiler(folder):
    """A clang++ that links a fuzzer."""
    trial = folder / "trial.cpp"
    trial.write_text('extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }\n')
    for name in ("clang++", *(f"clang++-{version}" for version in range(20, 13, -1))):
        compiler = shutil.which(name)
        if compiler is None:
            continue
        command = [compiler, *FLAGS, str(trial), "-o", str(folder / "trial")]
        if subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return compiler
    return None


def write_ninja(compiler, target, root, folder):
    """Builds by ninja, so that a second run compiles what has changed."""
    sources = [source for pattern in SOURCES[target] for source in sorted(root.glob(pattern))]
    lines = [f"flags = {' '.join(FLAGS)} -I{root}",
             "rule compile", f"  command = {compiler} $flags -MD -MF $out.d -c $in -o $out", "  depfile = $out.d",
             "  deps = gcc",
             "rule link", f"  command = {compiler} $flags $in -o $out {' '.join(LIBRARIES)}"]
    objects = []
    for source in sources:
        objects.append("-".join(source.relative_to(root).parts) + ".o")
        lines.append(f"build {objects[-1]}: compile {source}")
    lines.append(f"build fuzz: link {' '.join(objects)}")
    (folder / "build.ninja").write_text("\n".join(lines) + "\n")


def fuzz(target, root, folder, inputs):
    findings = folder / "findings"
    corpus = folder / "corpus"
    findings.mkdir(exist_ok=True)
    corpus.mkdir(exist_ok=True)
    before = set(findings.iterdir())
    seconds = os.environ.get("BOWSTRING_FUZZ_SECONDS", str(SECONDS))
    dictionary = root / "tests" / "fuzz" / (target.replace("-", "_") + ".dict")
    command = [str(folder / "fuzz"), f"-max_total_time={seconds}", f"-dict={dictionary}",
               f"-artifact_prefix={findings}/", "-timeout=20", "-rss_limit_mb=2048", "-max_len=8192",
               "-print_final_stats=1", "-verbosity=1", str(corpus), *inputs]
    suppressed = f"suppressions={root}/tests/fuzz/leaks.txt:print_suppressions=0"
    outcome = subprocess.run(command, env={**os.environ, "LSAN_OPTIONS": suppressed}, stderr=subprocess.STDOUT,
                             stdout=subprocess.PIPE, check=False)
    text = outcome.stdout.decode(errors="replace")
    found = sorted(set(findings.iterdir()) - before)
    if outcome.returncode == 0 and not found:
        print("\n".join(text.splitlines()[-12:]))
        return 0
    print("\n".join(text.splitlines()[-120:]))
    for file in found:
        print(f"finding: {file}\n  try it again: {folder / 'fuzz'} {file}")
    return 1


def main(target, root, build, *inputs):
    if "BOWSTRING_TEST_FULL" not in os.environ:
        skip("a fuzzer runs for minutes: in the full test only (./dev test --full)")
    folder = Path(build) / f"libfuzzer-{target}"
    folder.mkdir(parents=True, exist_ok=True)
    compiler = find_compiler(folder)
    if compiler is None:
        skip("no clang++ with libFuzzer (Debian: clang and libclang-rt-14-dev)")
    write_ninja(compiler, target, Path(root), folder)
    built = subprocess.run(["ninja", "-C", str(folder), "fuzz"], check=False)
    return built.returncode or fuzz(target, Path(root), folder, inputs)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
