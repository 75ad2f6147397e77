"""A penalty's error is its bias, which falls as 1/weight, on top of the mesh's error, which falls as 1/N²."""

import math

from study_run import expect, number, run

WEIGHTS = ("1e2", "1e3", "1e4", "1e5", "1e6")
NODES = (20, 40, 80)
STUCK = ("1e6", 40)  # two rows hardly press on this mesh, and kinks beside them are in Newton's way


def expect_bias(row, exact):
    bias = exact - number(row, "energy_N_mm")
    estimated = number(row, "estimated_bias_N_mm")
    expect(0 < bias < 0.25 and abs(estimated - bias) < 0.06 * bias, f"run {row['run']}: bias {bias}, told {estimated}")
    return bias


def test(study):
    study.expect_runs((2 + 2 * (len(WEIGHTS) + 1)) * len(NODES))
    exact = {n: number(study.one(enforcement="kkt", N=n), "energy_N_mm") for n in NODES}
    order = math.log2((exact[40] - exact[20]) / (exact[80] - exact[40]))
    expect(abs(order - 2) < 0.1, f"the energy's order in the mesh is {order}")
    for n in NODES:
        corrected = study.one(enforcement="augmented-lagrangian", N=n)
        expect(corrected["status"] == "converged", corrected["reason"])
        expect(abs(number(corrected, "energy_N_mm") - exact[n]) < 1e-8, f"augmented Lagrangian, N = {n}: a bias")
        smooth = study.one(enforcement="log-quadratic 1e6 N/mm", N=n, thresholds="0.1 mm allowed")
        expect(smooth["status"] == "converged", smooth["reason"])
        expect(0 < abs(number(smooth, "energy_N_mm") - exact[n]) < 1e-3, f"log-quadratic, N = {n}: another energy")
        biases = []
        for weight in WEIGHTS:
            judged = study.one(enforcement=f"penalty {weight} N/mm", N=n, thresholds="usual thresholds")
            allowed = study.one(enforcement=f"penalty {weight} N/mm", N=n, thresholds="0.1 mm allowed")
            expect(judged["status"] == "stalled", f"the certificate takes a penalty of {weight} N/mm for exact")
            if (weight, n) == STUCK and allowed["status"] == "stalled":
                expect("iteration limit" in allowed["reason"], allowed["reason"])
                continue
            expect("leaves a bias" in judged["reason"], judged["reason"])
            expect(allowed["status"] == "converged", allowed["reason"])
            expect(judged["energy_N_mm"] == allowed["energy_N_mm"], "thresholds change the answer")
            biases.append((float(weight), expect_bias(allowed, exact[n])))
        (first, large), (last, small) = biases[0], biases[-1]
        exponent = math.log(large / small) / math.log(first / last)
        expect(-1.05 < exponent < -0.95, f"N = {n}: the bias goes with the weight to the {exponent}")


run("enforcement", test)
