"""The figures that the preprint printed, within what its reproduction leaves of them."""

from study_run import expect, number, run

# Relative. The vessel's bending energy is the figure that the preprint's own discretisation of it decides most.
WITHIN = {"peak_displacement_mm": 0.006, "mean_displacement_nodes_mm": 0.007, "wire_length_mm": 0.001,
          "energy_total_N_mm": 0.005, "energy_wire_N_mm": 0.03, "energy_vessel_N_mm": 0.06, "energy_anchoring_N_mm": 0.01,
          "energy_axial_N_mm": 0.01, "contact_count": 0.06, "line_load_peak_N_per_mm": 0.06,
          "line_load_integral_N": 0.03}
# How many figures are printed of each row of its tables, by scene, EI and N.
PRINTED = {("planar", 65, 40): 6, ("planar", 65, 60): 6, ("planar", 65, 80): 11, ("planar", 65, 120): 6,
           ("planar", 65, 160): 6, ("planar", 200, 80): 2, ("planar", 500, 80): 2, ("planar", 1000, 80): 2,
           ("planar", 2000, 80): 2, ("planar", 6132, 80): 3, ("helix", 65, 60): 11}


def reference_of(column):
    """Where the reference of a quantity stands: its unit comes last."""
    for unit in ("_N_per_mm", "_N_mm", "_mm", "_N"):
        if column.endswith(unit):
            return f"{column[:-len(unit)]}_reference{unit}"
    return f"{column}_reference"


def test(study):
    study.expect_runs(len(PRINTED))
    for (scene, stiffness, nodes), count in PRINTED.items():
        row = study.one(scene=scene, EI_N_mm2=stiffness, N=nodes)
        where = f"{scene}, EI = {stiffness}, N = {nodes}"
        expect(row["status"] == "converged" and row["second_order"] == "minimum", row["reason"])
        printed = [column for column in WITHIN if row[reference_of(column)]]
        expect(len(printed) == count, f"{where}: {len(printed)} printed figures instead of {count}")
        for column in printed:
            ours, theirs = number(row, column), number(row, reference_of(column))
            expect(abs(ours - theirs) <= WITHIN[column] * theirs, f"{where}: {column} {ours}, {theirs}")
    shares = [number(row, "energy_wire_N_mm") / number(row, "energy_total_N_mm")
              for row in study.pick(scene="planar", EI_N_mm2=65)]
    expect(all(0.004 < share < 0.01 for share in shares), f"the wire's shares of the energy: {shares}")


run("preprint-tables", test)
