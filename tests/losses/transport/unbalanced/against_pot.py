"""against_pot.py TOOL: 'unbalanced' beside POT's unbalanced and partial transport and SciPy's linear programs."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), os.pardir))
from other_programs import Judge, count, need_pot, plan_of, problem, solve

need_pot()
import numpy as np
import ot
from scipy.optimize import linprog


def cases(seed, number, weights):
    """Random sizes, costs and masses of different sums; rho is of the costs' size."""
    random = np.random.default_rng(seed)
    for _ in range(number):
        m, n = random.integers(1, 16, 2)
        a, b = random.random(m) + 0.05, 2.0 * random.random(n) + 0.05
        cost = ((random.normal(size=(m, 1, 3)) - random.normal(size=(1, n, 3))) ** 2).sum(2)
        yield a, b, cost, float(random.choice(weights)) * cost.mean()


def divergence(x, y):
    return (np.where(x > 0.0, x * np.log(np.where(x > 0.0, x, 1.0) / y), 0.0) - x + y).sum()


def value(plan, a, b, cost, rho, epsilon=0.0):
    out = (plan * cost).sum() + rho * divergence(plan.sum(1), a) + rho * divergence(plan.sum(0), b)
    return out + (epsilon * divergence(plan, np.outer(a, b)) if epsilon > 0.0 else 0.0)


def without_entropy(tool, judge):
    all_cases = list(cases(1, count(100), [0.1, 0.5, 2.0]))
    answers = solve(tool, [problem("unbalanced", a, b, cost, marginal_weight=rho) for a, b, cost, rho in all_cases])
    for (a, b, cost, rho), answer in zip(all_cases, answers):
        judge.require(answer["status"] == "", answer["status"])
        pot = ot.unbalanced.mm_unbalanced(a, b, cost, rho, div="kl", numItermax=20000, stopThr=1e-15)
        ours, theirs = value(plan_of(answer, *cost.shape), a, b, cost, rho), value(pot, a, b, cost, rho)
        scale = abs(theirs)
        judge.within("KL, epsilon 0: value beside its own plan's", abs(answer["value"] - ours) / scale, 1e-13)
        judge.within("KL, epsilon 0: gap", answer["gap"] / scale, 1e-13)
        judge.within("KL, epsilon 0: above POT's mm_unbalanced", (ours - theirs) / scale, 1e-13)
        judge.within("KL, epsilon 0: below POT's mm_unbalanced", (theirs - ours) / scale, 1e-4)


def with_entropy(tool, judge):
    all_cases = list(cases(2, count(100), [0.1, 0.5, 2.0]))
    epsilons = [share * cost.mean() for (_, _, cost, _), share in zip(all_cases, np.tile([0.05, 0.2, 1.0], 100))]
    answers = solve(tool, [problem("unbalanced", a, b, cost, marginal_weight=rho, epsilon=epsilon)
                           for (a, b, cost, rho), epsilon in zip(all_cases, epsilons)])
    for (a, b, cost, rho), epsilon, answer in zip(all_cases, epsilons, answers):
        judge.require(answer["status"] == "", answer["status"])
        # POT's entropy is sum gamma log gamma: that of a product of weights is a cost more.
        shifted = cost - epsilon * np.log(a)[:, None] - epsilon * np.log(b)[None, :]
        pot = ot.unbalanced.sinkhorn_unbalanced(a, b, shifted, epsilon, rho, numItermax=100000, stopThr=1e-14)
        plan = plan_of(answer, *cost.shape)
        judge.within("KL, epsilon > 0: plan beside POT's sinkhorn_unbalanced", abs(plan - pot).max() / plan.sum(), 1e-10)
        theirs = value(pot, a, b, cost, rho, epsilon)
        judge.within("KL, epsilon > 0: value", abs(answer["value"] - theirs) / theirs, 1e-12)


def total_variation(tool, judge):
    all_cases = list(cases(3, count(100), [0.1, 0.3, 1.0]))
    answers = solve(tool, [problem("unbalanced", a, b, cost, penalty="total-variation", marginal_weight=rho)
                           for a, b, cost, rho in all_cases])
    for (a, b, cost, rho), answer in zip(all_cases, answers):
        judge.require(answer["status"] == "", answer["status"])
        m, n = cost.shape
        whole = rho * (a.sum() + b.sum())  # of a plan without mass
        sums = np.vstack([np.kron(np.eye(m), np.ones(n)), np.kron(np.ones(m), np.eye(n))])
        program = linprog((cost - 2.0 * rho).ravel(), A_ub=sums, b_ub=np.concatenate([a, b]), method="highs")
        judge.within("total variation: value beside SciPy's", abs(answer["value"] - whole - program.fun) / whole, 1e-12)
        mass = a.sum() + b.sum()  # POT takes one at most
        pot = mass * ot.partial.partial_wasserstein_lagrange(a / mass, b / mass, cost, reg_m=2.0 * rho)
        theirs = (pot * (cost - 2.0 * rho)).sum() + whole
        judge.within("total variation: value beside POT's", abs(answer["value"] - theirs) / whole, 1e-10)


judge = Judge()
without_entropy(sys.argv[1], judge)
with_entropy(sys.argv[1], judge)
total_variation(sys.argv[1], judge)
judge.finish()
