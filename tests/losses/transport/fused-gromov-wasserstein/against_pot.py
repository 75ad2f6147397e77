"""against_pot.py TOOL: 'fused-gromov-wasserstein' beside POT's, from the same start.

Both end in local minima; where these differ neither has to be the better one."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from other_programs import Judge, count, need_pot, plan_of, problem, solve

need_pot()
import numpy as np
import ot


def cases(number):
    random = np.random.default_rng(1)
    for k in range(number):
        m, n = random.integers(2, 21, 2)
        a, b = random.random(m) + 0.05, random.random(n) + 0.05
        x, y = random.normal(size=(m, 3)), random.normal(size=(n, 3)) + 0.5
        yield a / a.sum(), b / b.sum(), x, y, [0.1, 0.5, 0.9, 1.0][k % 4], ["distance", "squared-distance"][k // 4 % 2]


def distances(x, y, form):
    squared = ((x[:, None, :] - y[None, :, :]) ** 2).sum(2)
    return squared if form == "squared-distance" else np.sqrt(squared)


def value(plan, cost, structure_a, structure_b, alpha):
    apart = ((structure_a[:, None, :, None] - structure_b[None, :, None, :]) ** 2)
    return (1.0 - alpha) * (cost * plan).sum() + alpha * np.einsum("ijkl,ij,kl->", apart, plan, plan)


judge = Judge()
all_cases = list(cases(count(100)))
asked = [problem("fused-gromov-wasserstein", a, b, positions=(x, y), structure_weight=alpha, structure=form)
         for a, b, x, y, alpha, form in all_cases]
many = [problem("fused-gromov-wasserstein", a, b, positions=(x, y), structure_weight=alpha, structure=form, starts=10)
        for a, b, x, y, alpha, form in all_cases]
same = below = above = 0
for (a, b, x, y, alpha, form), answer, best in zip(all_cases, solve(sys.argv[1], asked), solve(sys.argv[1], many)):
    judge.require(answer["status"] == "", answer["status"])
    cost = distances(x, y, "squared-distance")
    own = distances(x, x, form), distances(y, y, form)
    ours = value(plan_of(answer, len(a), len(b)), cost, *own, alpha)
    if alpha < 1.0:
        pot = ot.gromov.fused_gromov_wasserstein(cost, *own, a, b, alpha=alpha, numItermax=1000)
    else:
        pot = ot.gromov.gromov_wasserstein(*own, a, b, numItermax=1000)
    theirs = value(pot, cost, *own, alpha)
    judge.within("value beside its own plan's", abs(answer["value"] - ours) / ours, 1e-12)
    judge.within("marginals", abs(plan_of(answer, len(a), len(b)).sum(1) - a).max(), 1e-14)
    judge.require(best["value"] <= answer["value"] * (1.0 + 1e-12), "more starts gave a larger value")
    judge.within("ten starts above POT's one", (best["value"] - theirs) / theirs, 1e-9)
    same += abs(ours - theirs) <= 1e-9 * theirs
    below += ours < theirs - 1e-9 * theirs
    above += ours > theirs + 1e-9 * theirs
print(f"of {len(all_cases)}: the same value {same} times, another local minimum below POT's {below}, above it {above}")
judge.require(same >= 0.9 * len(all_cases), f"the same value as POT only {same} times of {len(all_cases)}")
judge.finish()
