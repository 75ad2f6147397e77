"""Tension and stiffness of the wire: both raise the peak, each the less the larger the other, and energies obey the
envelope theorem, which no discretisation can break: the total's slope in T is J_axial/T, in EI it is J_wire/EI."""

import itertools

from study_run import expect, number, run

TENSION, STIFFNESS = "T_N", "EI_N_mm2"
TERM = {TENSION: "energy_axial_tension_N_mm", STIFFNESS: "energy_wire_bending_N_mm"}


def expect_rise_and_envelope(rows, parameter):
    """The total is a minimum over states of what is linear in the parameter: its slope falls."""
    rows = sorted(rows, key=lambda row: number(row, parameter))
    for low, high in itertools.pairwise(rows):
        place = f"run {low['run']} to {high['run']}, {parameter}"
        expect(number(high, "peak_displacement_mm") > number(low, "peak_displacement_mm"), f"{place}: the peak falls")
        step = number(high, parameter) - number(low, parameter)
        slope = (number(high, "energy_total_N_mm") - number(low, "energy_total_N_mm")) / step
        first, last = (number(row, TERM[parameter]) / number(row, parameter) for row in (low, high))
        expect(last < slope < first, f"{place}: slope {slope} outside {last} … {first}")


def growth(study, scene, parameter, **held):
    """Of the peak over the range of a parameter."""
    rows = sorted(study.pick(scene=scene, **held), key=lambda row: number(row, parameter))
    return number(rows[-1], "peak_displacement_mm") / number(rows[0], "peak_displacement_mm")


def test(study):
    study.expect_runs(2 * 3 * 5)
    expect(all(row["status"] == "converged" and row["second_order"] == "minimum" for row in study.rows),
           "a run is no minimum")
    for scene in ("planar", "helical"):
        for stiffness in {number(row, STIFFNESS) for row in study.rows}:
            expect_rise_and_envelope(study.pick(scene=scene, EI_N_mm2=stiffness), TENSION)
        for tension in (1, 5, 10, 15, 20):
            expect_rise_and_envelope(study.pick(scene=scene, T_N=tension), STIFFNESS)
        soft, stiff = growth(study, scene, TENSION, EI_N_mm2=65), growth(study, scene, TENSION, EI_N_mm2=6132)
        expect(soft > 2.5 * stiff, f"{scene}: 20-fold tension raises the peak {soft}-fold and {stiff}-fold")
        pushed, pulled = growth(study, scene, STIFFNESS, T_N=1), growth(study, scene, STIFFNESS, T_N=20)
        expect(pushed > 4 * pulled, f"{scene}: 94-fold stiffness raises the peak {pushed}-fold and {pulled}-fold")
    known = number(study.one(scene="planar", T_N=10, EI_N_mm2=65), "peak_displacement_mm")
    expect(abs(known - 9.74585) < 1e-4, f"the peak of the planar iliac from the end of a warm chain is {known} mm")


run("tension", test)
