"""Without stretch a vessel folds; without torsion, in space, iterations grow with the mesh and the kinematics part."""

from study_run import expect, number, run

BOTH = "stretch and torsion"
TOTAL = "energy_total_N_mm"


def iterations(study, **choice):
    return number(study.one(**choice), "iterations")


def expect_agreement(study):
    """The two kinematics are one discrete equilibrium wherever the vessel is well posed."""
    for scene, vessel, meshes in (("planar", "stretch", (40, 80)), ("helix", BOTH, (40, 80)), ("tortuous", BOTH, (80,))):
        for n in meshes:
            pairs = zip(study.pick(scene=scene, vessel=vessel, N=n, kinematics="nodes"),
                        study.pick(scene=scene, vessel=vessel, N=n, kinematics="edge-frames"))
            for one, other in pairs:
                for row in (one, other):
                    expect(row["status"] == "converged" and row["second_order"] == "minimum",
                           f"run {row['run']}: {row['reason']}")
                    expect(number(row, "iterations") <= 30 and number(row, "min_stretch") > 0.6, f"{row}")
                apart = abs(number(one, TOTAL) / number(other, TOTAL) - 1)
                expect(apart < 1e-9, f"{scene}, N = {n}: the kinematics are {apart} apart")


def expect_growth_without_torsion(study):
    for kinematics in ("nodes", "edge-frames"):
        for vessel, grows in (("bending only", True), ("stretch", True), (BOTH, False)):
            coarse, fine = (iterations(study, scene="helix", vessel=vessel, kinematics=kinematics, N=n) for n in (40, 80))
            where = f"helix, {vessel}, {kinematics}: {coarse} and {fine} iterations"
            expect(fine > 1.6 * coarse and fine > 50 if grows else fine < 1.3 * coarse, where)


def expect_folds_without_stretch(study):
    for vessel in ("bending only", "torsion"):
        for row in study.pick(scene="tortuous", vessel=vessel):
            where = f"tortuous, {vessel}, {row['kinematics']}: {row['status']}, {row['reason']}"
            expect(row["status"] == ("stalled" if row["kinematics"] == "nodes" else "invalid"), where)
            expect(number(row, "min_stretch") < 0.201, where)
            if row["status"] == "invalid":
                expect("give the vessel a stretch-stiffness" in row["reason"], where)
    for row in study.pick(scene="tortuous", vessel="stretch"):
        expect(row["status"] == "converged" and number(row, "iterations") > 30, f"{row}")


def test(study):
    study.expect_runs(2 * 2 * 2 + 2 * 4 * 2 + 4 * 2 * 2)
    expect_agreement(study)
    expect_growth_without_torsion(study)
    expect_folds_without_stretch(study)
    stretched, unstretched = (min(number(row, "min_stretch") for row in study.pick(scene="planar", vessel=vessel, N=80))
                              for vessel in ("stretch", "bending only"))
    expect(unstretched < 0.8 < 0.88 < stretched, f"the shortest planar edges: {unstretched} and {stretched}")


run("vessel-stiffness", test)
