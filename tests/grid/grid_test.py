"""The solver grid as a test: a twentieth of grid A by every native solver that is there, and about ten small scenes by the
reference solver as well; every result is re-checked by a program that shares no code with the kernel.
BOWSTRING_TEST_FULL: all grids, and the reference on all meshes that it takes seconds for. BOWSTRING_TEST_SHORT: a few
small scenes, for builds that are slow.

Arguments: the command, a folder for results (emptied), the re-checker. Which solvers: grid.NATIVE_SOLVERS, grid.REFERENCE_SOLVER."""

import os
import pathlib
import shutil
import sys

import grid
import scenes


def option(name, values):
    return [part for value in values for part in (name, value)]


def steps(offered, full, short, recheck):
    """Argument lists for the grid runner. Of the reference no second-order verdict and no number of iterations is
    expected."""
    native = [name for name in grid.NATIVE_SOLVERS if name in offered]
    reference = [name for name in (grid.REFERENCE_SOLVER,) if name in offered]
    common = ["--time-limit", "60", "--check", "--recheck", recheck]
    if native:
        part = ["--full", *option("--grid", scenes.GRIDS)] if full else ["--every", "20"]
        if short:
            part = ["--every", "40", "--nodes", "20,40,80,160"]
        yield [*option("--solver", native), *part, *common]
    if reference:
        part = ["--full", "--nodes", "20,40,80,160"] if full else ["--every", "28", "--nodes", "20,40,80"]
        expected = option("--expect", ["converged", "stationarity=1e-8"])
        yield [*option("--solver", [*native, *reference]), *part, *common, *expected]


def main(bowstring, folder, recheck):
    results = pathlib.Path(folder) / "results"
    shutil.rmtree(results, ignore_errors=True)
    full, short = (f"BOWSTRING_TEST_{size}" in os.environ for size in ("FULL", "SHORT"))
    codes = []
    for arguments in steps(grid.offered_solvers(bowstring), full, short, recheck):
        print("grid.py", *arguments, flush=True)
        codes.append(grid.main([bowstring, *arguments, "--out", str(results)]))
    if not codes:
        print(f"none of {', '.join((*grid.NATIVE_SOLVERS, grid.REFERENCE_SOLVER))} is installed")
        return 1
    print(f"{codes.count(0)} passed, {len(codes) - codes.count(0)} failed")
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
