"""The grid runner's own functions: choice of scenes, rows, fits, agreement, expectations, and the runner on a stand-in
for the command. Prints 'N passed, N failed'."""

import json
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import grid
import grid_test
import report
import results
import runner
import scenes
import summary


def row(solver="ipopt", name="scene", **given):
    out = dict.fromkeys(results.COLUMNS)
    out.update(solver=solver, grid="A", scene=name, anatomy="planar", kinematics="edge-frames", vessel="full",
               contact="node-wise", start="cold", nodes=80, wire_bending_N_mm2=65, tension_N=10, status="converged",
               second_order="minimum", weakly_active_count=0, iterations=12, solve_s=0.1, energy_N_mm=100.0,
               peak_displacement_mm=5.0, stationarity_N=1e-9, rounding_floor_N=0.0, crossings=0, folds=0, reason="")
    out.update(given)
    return out


class Scenes(unittest.TestCase):
    def test_grid_sizes(self):
        self.assertEqual(len(scenes.grid_a()), 672)
        self.assertEqual(len(scenes.grid_b()), 24)
        self.assertEqual(len({scene.name for scene in scenes.grid_a()}), 672)
        self.assertGreater(len(scenes.grid_c(True)), len(scenes.grid_c()))

    def test_a_tenth_meets_every_value_of_every_axis(self):
        everything, tenth = scenes.grid_a(), scenes.select(scenes.grid_a(), 10)
        self.assertEqual(len(tenth), 68)
        for axis in range(len(scenes.AXES)):
            self.assertEqual({scene.axes[axis] for scene in everything}, {scene.axes[axis] for scene in tenth})

    def test_the_order_depends_on_names_alone(self):
        forward = [scene.name for scene in scenes.shuffled(scenes.grid_a())]
        self.assertEqual(forward, [scene.name for scene in scenes.shuffled(scenes.grid_a()[::-1])])
        self.assertNotEqual(forward, [scene.name for scene in scenes.grid_a()])

    def test_meshes_and_names_narrow_the_choice(self):
        chosen = scenes.select(scenes.grid_a(), 1, {20, 40}, "helical")
        self.assertEqual(len(chosen), 672 // 7)
        self.assertEqual({scene.nodes for scene in chosen}, {20, 40})

    def test_a_warm_start_brings_what_it_starts_from(self):
        chosen = scenes.select(scenes.grid_w(), 1, None, "-warm-N80")
        self.assertEqual([bool(scene.after) for scene in chosen], [False, False, True, True])
        self.assertEqual({scene.after for scene in chosen[2:]}, {scene.name for scene in chosen[:2]})

    def test_an_artery_without_data_says_why_it_is_skipped(self):
        with mock.patch.dict(os.environ):
            os.environ.pop(scenes.DATA, None)
            self.assertIn(scenes.DATA, scenes.make("B", "artery", 200, 291, 5).skip)
            os.environ[scenes.DATA] = "/data"
            scene = scenes.make("B", "artery", 800, 291, 5)
        self.assertEqual(scene.skip, "")
        geometry = dict(scene.overrides)["vessel.iliac.geometry"]
        self.assertIn('"/data/vmr_0110/left_smoothed_200.csv", nodes = 800', geometry)

    def test_a_vessel_that_only_bends(self):
        stiffness = dict(scenes.make("C", "planar", 80, 65, 10, vessel="bending").overrides)
        self.assertEqual(stiffness["energy.vessel-strain.stretch-stiffness"], "0 N")


class Rows(unittest.TestCase):
    scene = scenes.make("A", "planar", 80, 65, 10)
    record = {"killed": False, "kill_after_s": 50.0, "exit": 0, "process_s": 1.0, "cpu_s": 0.9, "peak_memory_MB": 20.0,
              "stderr": ""}

    def test_a_document_becomes_a_row(self):
        document = {"status": "converged", "reason": "good", "energy": {"total": 7.0},
                    "solver": {"iterations": 9, "factorizations": None, "epochs": 1, "evaluations": 11,
                               "seconds": {"solve": 0.5, "total": 0.6, "evaluation": 0.1, "factorization": None}},
                    "certificate": {"second_order": None, "weakly_active": [4], "stationarity": 1e-9,
                                    "rounding_floor_N": 0.0, "max_penetration_mm": 0.0,
                                    "max_penetration_dense_mm": 0.01, "min_stretch": 0.9,
                                    "crossings": [], "folds": ["there"]},
                    "quantities": {"peak_displacement_mm": 3.0},
                    "provenance": {"plugins": [{"kind": "solver", "name": "ipopt", "sha256": "ab"}]}}
        made = results.row_of(self.scene, "ipopt", self.record, document, "out.json")
        self.assertEqual(set(made), set(results.COLUMNS))
        keys = ("nodes", "iterations", "weakly_active_count", "folds", "solve_s", "energy_N_mm", "solver_sha256",
                "factorizations")
        self.assertEqual([made[key] for key in keys], [80, 9, 1, 1, 0.5, 7.0, "ab", None])

    def test_runs_without_a_document(self):
        def status(**changed):
            made = results.row_of(self.scene, "ipopt", {**self.record, **changed}, None, "out.json")
            return made["status"]
        self.assertEqual(status(killed=True, exit=-9), "killed")
        self.assertEqual(status(exit=-11), "crashed")
        self.assertEqual(status(exit=2, stderr="unknown solver"), "refused")
        self.assertEqual(results.row_of(self.scene, "ipopt", None, None, "out.json")["status"], "skipped")

    def test_a_refused_start_is_not_available_and_nothing_else_is(self):
        for said, status in (("path 'start.from': 'start' is not available in this version", "not available"),
                             ("path 'start.from': there is no file 'first.json'", "refused")):
            record = {**self.record, "exit": 2, "stderr": said}
            self.assertEqual(results.status_without_document(record, True)[0], status)
            self.assertEqual(results.status_without_document(record, False)[0], "refused")

    def test_distance_of_nodes(self):
        first = {"wire": [[0.0, 0.0], [1.0, 0.0]], "vessel": [[0.0, 0.0]]}
        second = {"wire": [[0.0, 0.0], [4.0, 4.0]], "vessel": [[1.0, 0.0]]}
        self.assertEqual(results.largest_distance(first, second), 5.0)
        coarser = {"wire": [[0.0, 0.0]], "vessel": [[0.0, 0.0]]}
        self.assertEqual(results.largest_distance(first, coarser), float("inf"))


class Fits(unittest.TestCase):
    def test_a_power_law_is_found(self):
        self.assertAlmostEqual(summary.shared_slope([[(n, 3.0 * n ** 1.5) for n in (80, 160, 640)]]), 1.5)

    def test_groups_that_miss_meshes_do_not_tilt_the_slope(self):
        slow = [(n, 100.0 * n) for n in (80, 160)]
        fast = [(n, 0.1 * n) for n in (80, 160, 320, 640, 1280)]
        self.assertAlmostEqual(summary.shared_slope([slow, fast]), 1.0)

    def test_one_mesh_has_no_slope(self):
        self.assertIsNone(summary.shared_slope([[(80, 1.0)], []]))

    def test_exponents_by_solver(self):
        rows = [row(solver, nodes=n, solve_s=n ** power) for solver, power in (("ipopt", 2.0), ("interior-point", 1.0))
                for n in (20, 80, 160, 320)]
        rows[0]["solve_s"] = 1e9  # below the range of the fit
        exponents = summary.time_exponents(rows)
        self.assertAlmostEqual(exponents["A node-wise", "ipopt"], 2.0)
        self.assertAlmostEqual(exponents["A node-wise", "interior-point"], 1.0)


class Summaries(unittest.TestCase):
    def test_counts_and_failures(self):
        rows = [row(), row(status="stalled", reason="at 12.5 mm no more progress"), row(status="skipped"),
                row("interior-point")]
        counts = summary.status_counts(rows)
        self.assertEqual(counts["A", "ipopt"], {"converged": 1, "stalled": 1, "skipped": 1})
        self.assertEqual([failed["status"] for failed in summary.failures(rows)], ["stalled"])
        self.assertEqual(summary.kind_of_failure(rows[1]), "stalled: at mm no more progress")

    def test_figures_by_nodes(self):
        rows = [row(iterations=k) for k in (10, 12, 30)]
        rows += [row(iterations=99, status="stalled"), row(iterations=5, nodes=20)]
        self.assertEqual(summary.figures_by_nodes(rows, "iterations"),
                         {("A node-wise", "ipopt", 20): (1, 5, 5), ("A node-wise", "ipopt", 80): (3, 12, 30)})

    def test_formulations_of_contact_stand_apart(self):
        rows = [row(iterations=10), row(iterations=30, contact="segment-wise")]
        self.assertEqual([figures[1] for figures in summary.figures_by_nodes(rows, "iterations").values()], [10, 30])

    def test_iteration_ratio_of_a_family(self):
        rows = [row(nodes=n, iterations=k) for n, k in ((20, 1), (80, 10), (640, 25), (1280, 20))]
        rows += [row(nodes=80, tension_N=1, iterations=7)]
        (figures,) = summary.iteration_ratios(rows).values()
        self.assertEqual(figures, (10, 25, 2.5))

    def test_ratio_to_the_reference_takes_scenes_that_both_solved(self):
        rows = [row(name="a", solve_s=1.0), row(name="b", solve_s=1.0, status="stalled"),
                row("interior-point", name="a", solve_s=0.25), row("interior-point", name="b", solve_s=99.0)]
        self.assertEqual(summary.ratios_to(rows, "ipopt"), {("A node-wise", "interior-point", 80): (1, 0.25)})

    def test_agreement_tells_basins_apart(self):
        rows = [row(name="a"), row("active-set", name="a", energy_N_mm=100.001), row(name="b"),
                row("active-set", name="b", energy_N_mm=105.0), row("trust-region", name="b", status="stalled")]
        pairs = summary.agreement(rows, lambda first, second: 0.5)
        self.assertEqual([pair[:3] for pair in pairs], [("ipopt", "active-set", "a"), ("ipopt", "active-set", "b")])
        self.assertLess(pairs[0][3], summary.SAME_BASIN)
        self.assertGreater(pairs[1][3], summary.SAME_BASIN)
        text = report.summarise(rows, "ipopt", lambda first, second: 0.5).text()
        self.assertIn("Different basins", text)

    def test_a_report_renders_both_ways(self):
        rows = [row(name=f"{n}", nodes=n, solve_s=n / 1e3) for n in (80, 160)] + [row(status="invalid", reason="a | b")]
        made = report.summarise(rows, "ipopt", lambda first, second: 0.0, summary.unmet(rows), len(rows),
                                (2, [["x", "bad"]]))
        self.assertIn("invalid: a | b", made.text())
        self.assertIn("| A | ipopt | 3 | 2 | 1 |", made.text(markdown=True))
        self.assertIn("a \\| b", made.text(markdown=True))


class Expectations(unittest.TestCase):
    def missed(self, *rows, **expected):
        return [miss[0] for miss in summary.unmet(list(rows), expected or None)]

    def test_a_good_row_misses_nothing(self):
        self.assertEqual(self.missed(row()), [])

    def test_each_is_missed(self):
        self.assertEqual(self.missed(row(status="stalled", reason="")), ["converged"])
        self.assertEqual(self.missed(row(second_order=None)), ["minimum"])
        self.assertEqual(self.missed(row(second_order="saddle")), ["minimum"])
        self.assertEqual(self.missed(row(stationarity_N=2e-8)), ["stationarity"])
        self.assertEqual(self.missed(row(stationarity_N=2e-8, rounding_floor_N=2e-8)), [])
        self.assertEqual(self.missed(row(grid="B", iterations=36)), ["iterations"])
        self.assertEqual(self.missed(row(grid="B", status="invalid", crossings=1)), ["converged", "not-tunnelled"])

    def test_peak_of_two_meshes(self):
        coarse = row(grid="B", nodes=200, peak_displacement_mm=10.0)
        fine = row(grid="B", nodes=800, peak_displacement_mm=10.2)
        self.assertEqual(self.missed(coarse, fine), ["peak"])
        fine["peak_displacement_mm"] = 10.05
        self.assertEqual(self.missed(coarse, fine), [])

    def test_what_did_not_run_and_what_only_bends_is_not_judged(self):
        self.assertEqual(self.missed(row(status="skipped"), row(grid="W", status="not available"),
                                     row(grid="C", vessel="bending", status="stalled")), [])

    def test_options(self):
        self.assertEqual(summary.parse_expectations(["converged", "iterations=40"]),
                         {"converged": None, "iterations": 40.0})
        self.assertEqual(self.missed(row(iterations=41), iterations=40.0), ["iterations"])
        for wrong, said in (("convergent", "unknown expectation 'convergent'"), ("iterations", "iterations=NUMBER"),
                            ("converged=1", "expected 'converged'"), ("iterations=many", "iterations=NUMBER")):
            with self.assertRaisesRegex(ValueError, said):
                summary.parse_expectations([wrong])


STAND_IN = """#!{python}
import json, sys, pathlib
if sys.argv[1] == "plugins":
    print(json.dumps([dict(kind="solver", name="ipopt")]))
    sys.exit(0)
with open(pathlib.Path(__file__).with_name("calls"), "a") as log:
    log.write(" ".join(sys.argv[1:]) + "\\n")
given = dict(text.split("=", 1) for text in sys.argv if "=" in text)
if "start.from" in given:
    print("path 'start.from': 'start' is not available in this version", file=sys.stderr)
    sys.exit(2)
document = {document!r}
pathlib.Path(sys.argv[sys.argv.index("--out") + 1]).write_text(json.dumps(document))
"""
DOCUMENT = {"status": "converged", "reason": "", "energy": {"total": 7.0},
            "solver": {"iterations": 9, "factorizations": 10, "epochs": 1, "evaluations": 11,
                       "seconds": {"solve": 0.5, "total": 0.6}},
            "certificate": {"second_order": None, "weakly_active": [], "stationarity": 1e-9, "crossings": [],
                            "folds": []},
            "quantities": {"peak_displacement_mm": 3.0}, "curves": [], "provenance": {"plugins": []}}


class Running(unittest.TestCase):
    """With a stand-in for `bowstring` that writes down what it was called with."""

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.command = self.folder / "bowstring"
        self.command.write_text(STAND_IN.format(python=sys.executable, document=DOCUMENT))
        self.command.chmod(0o755)

    def rows(self, chosen, time_limit=5.0, fresh=False):
        with mock.patch("sys.stderr"):
            return grid.Runner(self.command, self.folder / "out", time_limit, fresh).run_all(chosen, ["ipopt"], 2)

    def calls(self):
        return (self.folder / "calls").read_text().splitlines()

    def test_what_is_there_is_not_run_again(self):
        chosen = scenes.select(scenes.grid_a(), 1, {20}, "planar-edge-frames-full-node-wise-cold-N20-EI65-")
        self.assertEqual(len(chosen), 6)
        first = self.rows(chosen)
        self.assertEqual([made["scene"] for made in first], [scene.name for scene in chosen])
        self.assertEqual(len(self.calls()), 6)
        self.assertIn("--set solver.time-limit=5", self.calls()[0])
        self.assertEqual(self.rows(chosen), first)
        self.assertEqual(len(self.calls()), 6)
        pathlib.Path(first[0]["result_file"]).write_text('{"status": "conv')  # half a document
        self.rows(chosen)
        self.assertEqual(len(self.calls()), 7)
        self.rows(chosen, fresh=True)
        self.assertEqual(len(self.calls()), 13)

    def test_a_longer_time_limit_runs_again_what_had_too_little(self):
        chosen = scenes.grid_a()[:1]
        (made,) = self.rows(chosen)
        pathlib.Path(made["result_file"]).write_text(json.dumps({**DOCUMENT, "status": "stalled"}))
        self.assertEqual(self.rows(chosen)[0]["status"], "stalled")
        self.assertEqual(self.rows(chosen, time_limit=50.0)[0]["status"], "converged")

    def test_a_warm_start_comes_after_and_from_its_first_scene(self):
        chosen = scenes.select(scenes.grid_w(), 1, None, "planar-edge-frames-full-node-wise-warm-N80")
        first, warm = self.rows(chosen)
        self.assertEqual((first["status"], warm["status"]), ("converged", "not available"))
        self.assertIn(f"start.from={first['result_file']}", self.calls()[1])

    def test_a_process_without_end_is_killed(self):
        self.command.write_text(f"#!{sys.executable}\nwhile True: pass\n")
        with mock.patch.object(runner, "kill_after", lambda limit: 0.2):
            (made,) = self.rows(scenes.grid_a()[:1])
        self.assertEqual(made["status"], "killed")

    def test_a_solver_that_is_not_there(self):
        with self.assertRaisesRegex(grid.WrongInput, "--solver ipop: .* expected one of: ipopt"):
            grid.chosen_solvers(self.command, ["ipop"])
        self.assertEqual(grid.chosen_solvers(self.command, None), ["ipopt"])

    def test_the_tests_choice_of_solvers_and_scenes(self):
        (only,) = grid_test.steps(["ipopt", "nlopt"], False, False, "recheck")
        self.assertEqual(only[:6], ["--solver", "ipopt", "--every", "28", "--nodes", "20,40,80"])
        self.assertLessEqual(len(grid.choose_scenes(grid.parse(["bowstring", *only]))), 12)
        for full in (False, True):
            native, both = grid_test.steps(["ipopt", "interior-point"], full, False, "recheck")
            self.assertNotIn("ipopt", native)
            self.assertIn("interior-point", both)
            chosen = grid.choose_scenes(grid.parse(["bowstring", *native]))
            self.assertEqual({scene.grid for scene in chosen}, set("ABCW") if full else {"A"})

    def test_recheck_names_what_does_not_hold(self):
        program = self.folder / "recheck"
        program.write_text(f"#!{sys.executable}\nimport sys\nprint('said')\n"
                           "sys.exit(any('bad' in file for file in sys.argv[1:]))\n")
        program.chmod(0o755)
        rows = [row(result_file=f"/runs/ipopt/{name}.json") for name in ("good", "bad", "fine")] + [row()]
        held, fallen = grid.recheck(str(program), rows)
        self.assertEqual(held, 2)
        self.assertEqual(fallen, [["ipopt/bad.json", "exit 1: said"]])


if __name__ == "__main__":
    tests = unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])
    outcome = unittest.TextTestRunner().run(tests)
    wrong = len(outcome.failures) + len(outcome.errors)
    print(f"{outcome.testsRun - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)
