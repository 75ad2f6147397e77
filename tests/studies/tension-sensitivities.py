"""Sensitivities at one place by central differences: what is linear in the energy has its share of it as elasticity of
the total, and anchoring cannot be told from extravascular tissue."""

import math

from study_run import expect, number, run

QUANTITIES = ["peak_displacement_mm", "mean_displacement_mm", "contact_force_N", "energy_total_N_mm", "wire_length_mm",
              "vessel_length_change_mm"]
AXES = ["T_N", "EI_N_mm2", "anchoring_N_per_mm2", "extravascular_N_per_mm2", "EI_vessel_N_mm2", "EA_vessel_N", "R_mm"]
SHARES = {"T_N": "energy_axial_tension_N_mm", "EI_N_mm2": "energy_wire_bending_N_mm",
          "anchoring_N_per_mm2": "energy_anchoring_N_mm", "extravascular_N_per_mm2": "energy_extravascular_N_mm"}


def elasticities(study, axis):
    centre = study.rows[0]
    varied = sorted((row for row in study.rows if row[axis] != centre[axis]), key=lambda row: number(row, axis))
    expect(len(varied) == 2, f"{len(varied)} runs vary {axis}")
    low, high = varied
    scale = number(centre, axis) / (number(high, axis) - number(low, axis))
    return [scale * (number(high, q) - number(low, q)) / number(centre, q) for q in QUANTITIES]


def test(study):
    study.expect_runs(1 + 2 * len(AXES))
    expect(all(row["status"] == "converged" for row in study.rows), "a run has not converged")
    centre = study.rows[0]
    found = {axis: elasticities(study, axis) for axis in AXES}
    total = QUANTITIES.index("energy_total_N_mm")
    for axis, term in SHARES.items():
        share = number(centre, term) / number(centre, "energy_total_N_mm")
        expect(share > 0.01 and abs(found[axis][total] - share) < 1e-3 * share,
               f"{axis}: elasticity {found[axis][total]} of the energy, share {share}")
    vessel = found["EI_vessel_N_mm2"][total] + found["EA_vessel_N"][total]
    share = number(centre, "energy_vessel_strain_N_mm") / number(centre, "energy_total_N_mm")
    expect(abs(vessel - share) < 1e-3 * share, f"the vessel's elasticities are {vessel}, its share {share}")

    one, other = found["anchoring_N_per_mm2"], found["extravascular_N_per_mm2"]
    expect(math.hypot(*one) > 0.1, "nothing feels the anchoring")
    expect(math.dist(one, other) < 1e-6, f"anchoring {one} and extravascular {other} are told apart")
    peak = {axis: values[0] for axis, values in found.items()}
    expect(max(peak, key=lambda axis: abs(peak[axis])) == "T_N", f"tension is not the first: {peak}")
    expect(peak["T_N"] > 0.4 and -0.3 < peak["R_mm"] < -0.2 and peak["anchoring_N_per_mm2"] < -0.15, f"{peak}")


run("tension-sensitivities", test)
