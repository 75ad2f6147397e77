#!/usr/bin/env python3
"""`sinkhorn` and POT on 100 random problems: plan, cost, value and both divergences.

    against_pot.py SOLVE_TRANSPORT_PROBLEMS

POT's values are ⟨C, P⟩ alone, and so is its divergence; the value with entropy is computed from POT's plan.
"""
import pathlib
import sys
import warnings

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from other_programs import Judge, need_pot, plan_of, problem, random_measure, solve  # noqa: E402

need_pot()
import numpy  # noqa: E402
import ot  # noqa: E402

PROBLEMS = 100
TOLERANCE = 1e-12  # of both programs, on the marginals
BOUND = 1e-9


def asked(a, b, epsilon, debiased, cost=None):
    given = {"cost": cost} if cost is not None else {"positions": (a[0], b[0])}
    debiased = "true" if debiased else "false"
    return problem("sinkhorn", a[1], b[1], epsilon=repr(float(epsilon)), debiased=debiased, tolerance=TOLERANCE, **given)


def solved(program, problems):
    answers = solve(program, problems)
    refused = [answer["status"] for answer in answers if answer["status"]]
    assert not refused and len(answers) == len(problems), refused
    return answers


def squared_distances(a, b):
    return ((a[0][:, None] - b[0][None]) ** 2).sum(axis=2)


def pot_plan(a, b, epsilon):
    plan = ot.bregman.sinkhorn_log(a[1], b[1], squared_distances(a, b), epsilon, numItermax=200000, stopThr=TOLERANCE)
    error = max(abs(plan.sum(axis=1) - a[1]).max(), abs(plan.sum(axis=0) - b[1]).max())
    assert error < 1e-11, f"POT has not converged, its marginals are off by {error}: nothing to compare with"
    return plan


def cost(a, b, plan):
    return (squared_distances(a, b) * plan).sum()


def value(a, b, plan, epsilon):
    ratio = plan / numpy.outer(a[1], b[1])
    entropy = (plan * numpy.log(numpy.where(ratio > 0, ratio, 1.0))).sum()
    return cost(a, b, plan) + epsilon * entropy


def compare_plans(random, program, judge):
    cases, problems = [], []
    for k in range(PROBLEMS):
        a, b = random_measure(random), random_measure(random)
        epsilon = squared_distances(a, b).max() * 10 ** random.uniform(-1.7, 0.3)
        cases.append((a, b, epsilon))
        matrix = squared_distances(a, b) if k % 3 == 0 else None
        problems.append(asked(a, b, epsilon, False, matrix))
    for (a, b, epsilon), ours in zip(cases, solved(program, problems)):
        scale = squared_distances(a, b).max()
        plan = pot_plan(a, b, epsilon)
        judge.within("plan, of the whole mass", abs(plan_of(ours, *plan.shape) - plan).max(), BOUND)
        judge.within("cost, of the largest", abs(ours["transport_cost"] - cost(a, b, plan)) / scale, BOUND)
        judge.within("value, of the largest cost", abs(ours["value"] - value(a, b, plan, epsilon)) / scale, BOUND)
        judge.within("gap, of the largest cost", abs(ours["gap"]) / scale, BOUND)


def compare_divergences(random, program, judge):
    """At larger ε: POT goes from one side to the other, which of a measure to itself leaves 1 − exp(−C/ε) of an error."""
    cases, problems = [], []
    for _ in range(PROBLEMS):
        a, b = random_measure(random), random_measure(random)
        scale = max(squared_distances(p, q).max() for p, q in ((a, b), (a, a), (b, b)))
        epsilon = scale * 10 ** random.uniform(-0.8, 0.5)
        cases.append((a, b, epsilon, scale))
        problems.append(asked(a, b, epsilon, True))
        problems += [asked(p, q, epsilon, False) for p, q in ((a, b), (a, a), (b, b))]
    found = solved(program, problems)
    for k, (a, b, epsilon, scale) in enumerate(cases):
        divergence, *ours = found[4 * k : 4 * k + 4]
        values = [value(p, q, pot_plan(p, q, epsilon), epsilon) for p, q in ((a, b), (a, a), (b, b))]
        expected = values[0] - 0.5 * (values[1] + values[2])
        judge.within("divergence, of the largest cost", abs(divergence["value"] - expected) / scale, BOUND)
        of_costs = ours[0]["transport_cost"] - 0.5 * (ours[1]["transport_cost"] + ours[2]["transport_cost"])
        theirs = ot.bregman.empirical_sinkhorn_divergence(
            a[0], b[0], epsilon, a[1], b[1], numIterMax=200000, stopThr=TOLERANCE
        )
        # POT cuts its own off at zero.
        judge.within("POT's divergence, of costs alone", abs(max(of_costs, 0.0) - float(theirs)) / scale, BOUND)


def main():
    warnings.filterwarnings("error", message=".*did not converge.*")
    random, judge = numpy.random.default_rng(8), Judge()
    compare_plans(random, sys.argv[1], judge)
    compare_divergences(random, sys.argv[1], judge)
    judge.finish()


if __name__ == "__main__":
    main()
