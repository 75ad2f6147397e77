"""Springs per node, and nothing else, keep the peak displacement from converging."""

import math

from study_run import expect, number, run

NODES = (20, 40, 80, 160)
CONTACTS = ("same-index", "node-wise", "segment-wise")
PEAK, TOTAL = "peak_displacement_mm", "energy_total_N_mm"


def line(study, column, **choice):
    return [number(study.one(N=n, **choice), column) for n in NODES]


def order(values):
    """From the differences of the three finest meshes, each twice as fine as the one before."""
    return math.log2((values[-2] - values[-3]) / (values[-1] - values[-2]))


def limit(values):
    return values[-1] + (values[-1] - values[-2]) / 3


def expect_order_two(study, vessel):
    for contact in CONTACTS:
        choice = {"vessel": vessel, "anchoring": "per length", "contact": contact}
        peak, total = line(study, PEAK, **choice), line(study, TOTAL, **choice)
        expect(1.7 < order(peak) < 2.5, f"{choice}: order {order(peak)} of the peak, {peak}")
        expect(1.9 < order(total) < 2.2, f"{choice}: order {order(total)} of the energy, {total}")


def expect_limits(study, vessel, known, index_error):
    peak = {contact: limit(line(study, PEAK, vessel=vessel, anchoring="per length", contact=contact))
            for contact in CONTACTS}
    expect(abs(peak["node-wise"] - known) < 1e-3 * known, f"{vessel}: node-wise rows go to {peak}")
    expect(abs(peak["segment-wise"] - peak["node-wise"]) < 2e-4 * known, f"{vessel}: segment-wise rows: {peak}")
    apart = peak["same-index"] / peak["node-wise"] - 1
    expect(abs(apart - index_error) < 0.1 * index_error, f"{vessel}: same-index rows are {apart} off")


def expect_drift(study, vessel):
    """Per node the tissue is N times as stiff: towards a rigid vessel, whose total is 209.03 N mm."""
    for contact in CONTACTS:
        choice = {"vessel": vessel, "anchoring": "per node", "contact": contact}
        peak, total = line(study, PEAK, **choice), line(study, TOTAL, **choice)
        steps = [coarse - fine for coarse, fine in zip(peak, peak[1:])]
        expect(min(steps) > 1.5 and order(peak) < 0.2, f"{choice}: the peak settles, {peak}")
        rates = [math.log2(coarse / fine) for coarse, fine in zip(peak, peak[1:])]
        expect(0 < rates[0] < rates[1] < rates[2] < 1, f"{choice}: rates of fall {rates}")
        expect(total == sorted(total) and total[-1] < 209.03, f"{choice}: the energy, {total}")


def test(study):
    study.expect_runs(2 * 2 * len(CONTACTS) * len(NODES))
    for row in study.rows:
        expect(row["status"] == "converged" and row["second_order"] == "minimum", f"run {row['run']}: {row['reason']}")
    for vessel, known, index_error in (("well posed", 9.7503, 0.0054), ("as published", 10.5543, 0.0225)):
        expect_order_two(study, vessel)
        expect_limits(study, vessel, known, index_error)
        expect_drift(study, vessel)
    for contact in CONTACTS:
        same = [number(study.one(vessel="well posed", anchoring=anchoring, contact=contact, N=80), PEAK)
                for anchoring in ("per node", "per length")]
        expect(abs(same[0] - same[1]) < 2e-4 * same[1], f"{contact}: at 80 nodes both springs are one, {same}")
    for n, printed in ((40, 13.10), (80, 9.97), (160, 6.89)):
        ours = number(study.one(vessel="as published", anchoring="per node", contact="node-wise", N=n), PEAK)
        expect(abs(ours - printed) < 0.005 * printed, f"N = {n}: {ours}, printed {printed}")
    reference = number(study.rows[0], "peak_displacement_reference_mm")
    expect(abs(reference - 9.7503) < 2e-3, f"the reference of the study is {reference}")


run("mesh-convergence", test)
