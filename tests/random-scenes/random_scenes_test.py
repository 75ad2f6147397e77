"""Random scenes as a test: 100 that have a minimum, and as many without in proportion, by both native solvers.
BOWSTRING_TEST_FULL: 2000. BOWSTRING_TEST_SHORT: 20, for builds that are slow.

Arguments: the command, a folder for results, the re-checker."""

import os
import pathlib
import sys

import random_scenes

LEAST_SHARE, LEAST_SHARE_FULL = 0.98, 0.99


def steps(full, short, recheck):
    posed, unposed, share = (2000, 400, LEAST_SHARE_FULL) if full else (100, 20, LEAST_SHARE)
    if short:
        posed, unposed, share = 20, 5, 0.9
    common = ["--check", "--recheck", recheck]
    yield ["--scenes", str(posed), "--share", f"{share:g}", *common]
    yield ["--scenes", str(unposed), "--group", "unposed", *common]


def main(bowstring, folder, recheck):
    full, short = (f"BOWSTRING_TEST_{size}" in os.environ for size in ("FULL", "SHORT"))
    codes = []
    for arguments in steps(full, short, recheck):
        print("random_scenes.py", *arguments, flush=True)
        out = pathlib.Path(folder) / ("unposed" if "unposed" in arguments else "posed")
        codes.append(random_scenes.main([bowstring, *arguments, "--out", str(out)]))
    print(f"{codes.count(0)} passed, {len(codes) - codes.count(0)} failed")
    return 1 if any(codes) else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
