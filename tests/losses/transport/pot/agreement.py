#!/usr/bin/env python3
"""Transport methods against Python's POT on random problems.

    agreement.py BOWSTRING METHOD

Skipped (exit code 77) where python3-pot is not installed. 100 problems; 10 under sanitizers (BOWSTRING_TEST_SHORT).
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import ot
    from scipy.special import xlogy
except ImportError as error:
    print(f"skipped: {error}; Debian: python3-pot")
    sys.exit(77)

PROBLEMS = 10 if os.environ.get("BOWSTRING_TEST_SHORT") else 100


class Problem:
    """Two weighted clouds of up to 20 points, some with equal weights, some with places without weight."""

    def __init__(self, seed):
        draw = np.random.default_rng(seed)
        m, n = (int(k) for k in draw.integers(1, 21, 2))
        self.x, self.y = draw.normal(size=(m, 3)), draw.normal(size=(n, 3)) + draw.normal(size=3)
        self.a, self.b = draw.uniform(0.1, 1.0, m), draw.uniform(0.1, 1.0, n)
        if seed % 4 == 0:
            self.a, self.b = np.ones(m), np.ones(n)
        if seed % 5 == 0 and m > 2:
            self.a[1] = 0.0
        self.a /= self.a.sum()
        self.b /= self.b.sum()
        self.cost = ot.dist(self.x, self.y)
        self.draw = draw


class Command:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def run(self, problem, method, **settings):
        files = []
        for name, points, weights in (("a", problem.x, problem.a), ("b", problem.y, problem.b)):
            file = self.folder / f"{name}.csv"
            rows = "".join(f"{x!r},{y!r},{z!r},{w!r}\n" for (x, y, z), w in zip(points.tolist(), weights.tolist()))
            file.write_text("x_mm,y_mm,z_mm,weight\n" + rows)
            files.append(file)
        sets = [word for key, value in settings.items() for word in ("--set", f"{key.replace('_', '-')}={value}")]
        call = [self.program, "transport", *files, "--method", method, *sets, "--json"]
        done = subprocess.run(call, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)


def check(seed, what, ours, theirs, tolerance, scale=1.0):
    error = abs(ours - theirs) / max(abs(theirs), scale)
    assert error <= tolerance, f"problem {seed}: {what} {ours!r} here, {theirs!r} by POT: {error:.1e} > {tolerance:.0e}"
    return error


def exact(command, seed, method):
    problem = Problem(seed)
    found = command.run(problem, method)
    return check(seed, "value", found["value"], ot.emd2(problem.a, problem.b, problem.cost, numItermax=10**6), 1e-10)


def entropic_plan(a, b, cost, epsilon):
    return ot.bregman.sinkhorn_log(a, b, cost, epsilon, numItermax=200000, stopThr=1e-13, warn=False)


def entropic_value(a, b, cost, epsilon):
    """<C, P> + epsilon KL(P | a b^T) at POT's plan, places without weight left out."""
    rows, columns = a > 0, b > 0
    a, b, cost = a[rows], b[columns], cost[np.ix_(rows, columns)]
    plan = entropic_plan(a, b, cost, epsilon)
    return (plan * cost).sum() + epsilon * xlogy(plan, plan / np.outer(a, b)).sum(), (plan * cost).sum()


def sinkhorn(command, seed):
    problem = Problem(seed)
    epsilon = float(problem.draw.uniform(0.1, 1.0) * np.median(problem.cost))
    found = command.run(problem, "sinkhorn", epsilon=epsilon, debiased="false", tolerance=1e-12)
    value, cost = entropic_value(problem.a, problem.b, problem.cost, epsilon)
    errors = [check(seed, "transport cost", found["transport_cost"], cost, 1e-8)]
    errors.append(check(seed, "regularized value", found["value"], value, 1e-8))
    divergence = command.run(problem, "sinkhorn", epsilon=epsilon, tolerance=1e-12)["value"]
    own = [entropic_value(w, w, ot.dist(p, p), epsilon)[0] for p, w in ((problem.x, problem.a), (problem.y, problem.b))]
    errors.append(check(seed, "divergence", divergence, value - 0.5 * sum(own), 1e-8))
    return max(errors)


class MersenneTwister64:
    """std::mt19937_64 (T. Nishimura, ACM Trans. Model. Comput. Simul. 10 (2000) 348)."""

    def __init__(self, seed):
        self.state = [seed]
        for i in range(1, 312):
            last = self.state[-1]
            self.state.append((6364136223846793005 * (last ^ (last >> 62)) + i) % 2**64)
        self.next = 312

    def __call__(self):
        if self.next == 312:
            for i in range(312):
                x = (self.state[i] & 0xFFFFFFFF80000000) | (self.state[(i + 1) % 312] & 0x7FFFFFFF)
                self.state[i] = self.state[(i + 156) % 312] ^ (x >> 1) ^ (0xB5026F5AA96619E9 if x & 1 else 0)
            self.next = 0
        x = self.state[self.next]
        self.next += 1
        x ^= (x >> 29) & 0x5555555555555555
        x ^= (x << 17) & 0x71D67FFFEDA60000
        x ^= (x << 37) & 0xFFF7EEE000000000
        return x ^ (x >> 43)

    def uniform(self):
        return (self() >> 11) * 2.0**-53


def lines(count, seed):
    """The axes of uniformly drawn rotations, as losses/transport/sliced draws them."""
    generator, out = MersenneTwister64(seed), []
    while len(out) < count:
        share = generator.uniform()
        one, two = 2 * math.pi * generator.uniform(), 2 * math.pi * generator.uniform()
        r, s = math.sqrt(1 - share), math.sqrt(share)
        w, x, y, z = s * math.cos(two), r * math.sin(one), r * math.cos(one), s * math.sin(two)
        out += [
            (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)),
        ]
    return np.array(out[:count]).T


def sliced(command, seed):
    problem = Problem(seed)
    count = int(problem.draw.integers(1, 40))
    found = command.run(problem, "sliced", directions=count, seed=seed)
    # It divides by n_projections, whatever the number of projections that it is given.
    theirs = ot.sliced_wasserstein_distance(
        problem.x, problem.y, problem.a, problem.b, n_projections=count, projections=lines(count, seed)
    )
    return check(seed, "value", found["value"], theirs**2, 1e-10)


def main():
    program, method = sys.argv[1:]
    judge = {"sinkhorn": sinkhorn, "sliced": sliced}.get(method, lambda c, seed: exact(c, seed, method))
    with tempfile.TemporaryDirectory() as folder:
        command = Command(program, folder)
        worst = max(judge(command, seed) for seed in range(PROBLEMS))
    print(f"{method}: {PROBLEMS} problems, largest difference {worst:.1e}")


if __name__ == "__main__":
    main()
