#!/usr/bin/env python3
"""`sliced` and POT on 100 random problems, over the same lines.

    against_pot.py SOLVE_TRANSPORT_PROBLEMS PRINT_DIRECTIONS
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from other_programs import Judge, need_pot, plan_of, problem, random_measure, solve  # noqa: E402

need_pot()
import numpy  # noqa: E402
import ot  # noqa: E402

PROBLEMS = 100


def directions(program, count, seed):
    """3 × count."""
    out = subprocess.run([program, str(count), str(seed)], check=True, capture_output=True, text=True).stdout
    return numpy.array([[float(number) for number in line.split()] for line in out.splitlines()]).T


def main():
    random = numpy.random.default_rng(8)
    cases, problems = [], []
    for _ in range(PROBLEMS):
        a, b = random_measure(random), random_measure(random)
        count, seed = int(random.integers(1, 80)), int(random.integers(0, 1000))
        cases.append((a, b, count, seed))
        problems.append(problem("sliced", a[1], b[1], positions=(a[0], b[0]), directions=count, seed=seed))
    judge = Judge()
    answers = solve(sys.argv[1], problems)
    assert len(answers) == PROBLEMS and not any(answer["status"] for answer in answers), answers
    for (a, b, count, seed), ours in zip(cases, answers):
        lines = directions(sys.argv[2], count, seed)
        assert lines.shape == (3, count), f"{lines.shape} directions, expected 3 x {count}"
        judge.within("length of a direction", abs((lines**2).sum(axis=0) - 1.0).max(), 1e-14)
        # POT 0.8.2 divides by `n_projections` even where it is given the lines.
        theirs = ot.sliced_wasserstein_distance(a[0], b[0], a[1], b[1], count, projections=lines, p=2) ** 2
        judge.within("value, relative", abs(ours["value"] - theirs) / theirs, 1e-12)
        plan = plan_of(ours, len(a[1]), len(b[1]))
        squared = ((a[0][:, None] - b[0][None]) ** 2).sum(axis=2)
        judge.within("cost of the plan, relative", abs(ours["transport_cost"] - (squared * plan).sum()) / theirs, 1e-12)
        # The plans of lines are plans: the mean's cost is not below the least.
        least = ot.emd2(a[1], b[1], squared)
        judge.within("below the least cost, relative", max(least - ours["transport_cost"], 0.0) / least, 1e-12)
        judge.within("mass of rows and columns", max(abs(plan.sum(1) - a[1]).max(), abs(plan.sum(0) - b[1]).max()), 1e-14)
    judge.finish()


if __name__ == "__main__":
    main()
