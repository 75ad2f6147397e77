"""Counts test cases over all test programs of one `meson test` run, from its testlog.json, and prints as last line
'N passed, N failed' (with ', N skipped' where some were). A program says itself how many cases it ran, by doctest's
summary or by such a line of its own; otherwise it counts as one. Fails without any passed test, or with a failed one."""

import json
import re
import sys

DOCTEST = re.compile(
    r"\[doctest\] test cases: +\d+ \| +(?P<passed>\d+) passed \| +(?P<failed>\d+) failed \| +(?P<skipped>\d+) skipped")
PLAIN = re.compile(r"^(?P<passed>\d+) passed, (?P<failed>\d+) failed(?:, (?P<skipped>\d+) skipped)?$", re.MULTILINE)


def count(test):
    """(passed, failed, skipped) of one program."""
    good = test["result"] in ("OK", "EXPECTEDFAIL")
    skipped = test["result"] == "SKIP"
    told = None
    for pattern in (DOCTEST, PLAIN):
        for told in pattern.finditer(test.get("stdout", "")):
            pass
        if told:
            break
    if not told:
        return (int(good), int(not good and not skipped), int(skipped))
    passed, failed, left_out = (int(told[key] or 0) for key in ("passed", "failed", "skipped"))
    if not good and not skipped and failed == 0:
        failed = 1  # a crash or a leak after the last case
    return (passed, failed, left_out)


def main(log):
    try:
        with open(log, encoding="utf-8") as lines:
            tests = [json.loads(line) for line in lines if line.strip()]
    except FileNotFoundError:
        tests = []
    counts = {test["name"]: count(test) for test in tests}
    for name, (_, failed, _) in counts.items():
        if failed:
            print(f"failed: {name} ({failed})")
    passed, failed, skipped = (sum(column) for column in zip((0, 0, 0), *counts.values()))
    if passed == 0 and failed == 0:
        print("no test ran")
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
