"""Problems for `solve-transport-problems`, to be solved by Python's POT as well. Exits with 77 where there is no POT."""
import json
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77

try:
    import numpy
    import ot
except ImportError as error:
    print(f"{error}: install python3-pot to compare with it")
    sys.exit(SKIPPED)


def random_measure(random, size=1.0):
    """Places in a cube and weights that sum to 1."""
    count = random.integers(1, 31)
    weight = 0.05 + random.random(count)
    return size * random.random((count, 3)), weight / weight.sum()


def problem(method, a, b, settings, cost=None):
    """`a`, `b`: places and weights. With `cost` the method is given the matrix alone."""
    out = {
        "method": method,
        "settings": {key: str(value) for key, value in settings.items()},
        "weight_a": a[1].tolist(),
        "weight_b": b[1].tolist(),
    }
    if cost is None:
        return out | {"position_a": a[0].ravel().tolist(), "position_b": b[0].ravel().tolist()}
    return out | {"cost": cost.ravel().tolist()}


def answers(program, problems):
    """What a build says of the problems, each of which it has to solve."""
    with tempfile.TemporaryDirectory() as folder:
        given, found = pathlib.Path(folder) / "problems.json", pathlib.Path(folder) / "answers.json"
        given.write_text(json.dumps(problems))
        subprocess.run([program, given, found], check=True)
        out = json.loads(found.read_text())
    assert len(out) == len(problems), f"{len(out)} answers to {len(problems)} problems"
    for k, answer in enumerate(out):
        assert answer["status"] == "", f"problem {k}: {answer['status']}"
    return out


def plan_of(answer, shape):
    out = numpy.zeros(shape)
    numpy.add.at(out, (answer["row"], answer["column"]), answer["mass"])
    return out


class Largest:
    """The largest difference of each name, and its bound."""

    def __init__(self):
        self.found = {}

    def note(self, name, difference, bound):
        before = self.found.get(name, (0.0, bound, 0))
        worst = difference if not difference <= before[0] else before[0]  # also one that is no number
        self.found[name] = (worst, bound, before[2] + 1)

    def report(self):
        for name, (difference, bound, count) in self.found.items():
            print(f"{name}: {difference:.2g} at most of {count}, expected below {bound:g}")
        wrong = [name for name, (difference, bound, _) in self.found.items() if not difference <= bound]
        assert not wrong, "too far off: " + ", ".join(wrong)
