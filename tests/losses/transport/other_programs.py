"""Comparisons with Python's POT and SciPy: problems go to solve-transport-problems by file, answers come back."""

import json
import os
import subprocess
import sys
import tempfile

SKIP = 77


def need_pot():
    """POT, NumPy and SciPy, of this interpreter or of Debian's own; the test skips without them."""
    try:
        import numpy, ot, scipy.optimize  # noqa: F401
    except ImportError as error:
        debian = "/usr/bin/python3"
        if os.path.realpath(sys.executable) != os.path.realpath(debian) and os.path.exists(debian):
            os.execv(debian, [debian] + sys.argv)
        print(f"skipped: {error}; Debian has python3-pot")
        sys.exit(SKIP)


def count(wanted):
    return max(1, wanted // 10) if "BOWSTRING_TEST_SHORT" in os.environ else wanted


def random_measure(random):
    """Places in a cube of 10 mm and weights that sum to 1."""
    places = random.integers(1, 31)
    weight = 0.05 + random.random(places)
    return 10.0 * random.random((places, 3)), weight / weight.sum()


def solve(tool, problems):
    with tempfile.TemporaryDirectory() as folder:
        asked, answered = os.path.join(folder, "problems.json"), os.path.join(folder, "answers.json")
        with open(asked, "w") as out:
            json.dump(problems, out)
        subprocess.run([tool, asked, answered], check=True)
        with open(answered) as source:
            return json.load(source)


def problem(method, a, b, cost=None, positions=None, **settings):
    """`cost`: a matrix; or `positions`: two arrays of points."""
    out = {"method": method, "settings": {key.replace("_", "-"): str(value) for key, value in settings.items()},
           "weight_a": a.tolist(), "weight_b": b.tolist()}
    if cost is not None:
        out["cost"] = cost.ravel().tolist()
    else:
        out["position_a"], out["position_b"] = (points.ravel().tolist() for points in positions)
    return out


def plan_of(answer, rows, columns):
    import numpy
    plan = numpy.zeros((rows, columns))
    plan[answer["row"], answer["column"]] = answer["mass"]
    return plan


class Judge:
    """Collects what is off; `largest` of each name is printed at the end."""

    def __init__(self):
        self.largest, self.failures = {}, []

    def within(self, name, error, tolerance):
        self.largest[name] = max(self.largest.get(name, 0.0), error)
        if not error <= tolerance:
            self.failures.append(f"{name}: {error:.3g}, expected at most {tolerance:.3g}")

    def require(self, holds, text):
        if not holds:
            self.failures.append(text)

    def finish(self):
        for name, error in self.largest.items():
            print(f"{name}: at most {error:.2e}")
        print("\n".join(self.failures[:20]) or "all hold")
        sys.exit(1 if self.failures else 0)
