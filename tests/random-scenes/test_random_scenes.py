"""The drawing of random scenes and the counting of what became of them. Prints 'N passed, N failed'."""

import math
import pathlib
import sys
import tempfile
import unittest

import random_scenes  # first: it makes the grid's modules importable
import curves
import drawing

SCENES = 60


def row(**given):
    out = dict.fromkeys(random_scenes.COLUMNS)
    out.update(drawing.draw(1, 0).axes)
    out.update(solver="active-set", scene="posed-1-0000", status="converged", second_order="minimum", reason="",
               iterations=12, solve_s=0.1, process_s=0.2, result_file="runs/active-set/posed-1-0000.json")
    out.update(given)
    return out


class Shapes(unittest.TestCase):
    def test_lengths_and_curvatures_of_known_curves(self):
        arc = curves.arc(20.0, -1.5)
        self.assertAlmostEqual(arc.length, 30.0, 9)
        self.assertAlmostEqual(max(arc.curvature), 0.05, 12)
        self.assertLess(arc.points[-1][1], 0.0)
        helix = curves.helix(100.0, 10.0, 2.0)
        around = 2.0 * math.pi * 2.0 * 10.0
        self.assertAlmostEqual(helix.length, math.hypot(100.0, around), 6)
        self.assertAlmostEqual(max(helix.curvature), 10.0 * (2.0 * math.pi * 2.0 / helix.length) ** 2, 9)
        self.assertAlmostEqual(curves.line(80.0).chord, 80.0, 12)

    def test_a_bend_of_arcs_turns_by_its_angle_and_stays_in_its_plane(self):
        shape = curves.arcs([(40.0, 1.2, 0.5)])
        before, last = shape.points[-2], shape.points[-1]
        tangent = [(b - a) / math.dist(before, last) for a, b in zip(before, last)]
        self.assertAlmostEqual(math.acos(tangent[0]), 1.2, 3)
        self.assertAlmostEqual(math.atan2(last[2], last[1]), 0.5, 9)
        self.assertAlmostEqual(max(shape.curvature), 2.0 * 1.2 / 40.0, 3)

    def test_limbs(self):
        hairpin = curves.arcs([(60.0, 0.0, 0.0), (60.0, math.pi, 0.0), (60.0, 0.0, 0.0)])
        apart = math.dist(hairpin.points[0], hairpin.points[-1])
        self.assertGreater(apart, 10.0)
        self.assertTrue(curves.limbs_apart(hairpin, lambda s: 0.3 * apart, 1.0))
        self.assertFalse(curves.limbs_apart(hairpin, lambda s: 0.7 * apart, 1.0))


class Scenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.drawn = [drawing.draw(3, number) for number in range(SCENES)]

    def test_a_scene_depends_on_its_numbers_alone(self):
        again = drawing.draw(3, 7)
        self.assertEqual((again.text, again.axes), (self.drawn[7].text, self.drawn[7].axes))
        self.assertNotEqual(drawing.draw(4, 7).text, again.text)
        self.assertNotEqual(drawing.draw(3, 8).text, again.text)

    def test_what_is_documented_holds(self):
        for scene in self.drawn:
            axes = scene.axes
            self.assertTrue(60.0 <= axes["vessel_length_mm"] <= 500.0)
            self.assertTrue(12 <= axes["vessel_nodes"] <= 640)
            self.assertLess(axes["tube_curvature"], 0.75)
            self.assertLessEqual(axes["tortuosity"], 2.5)
            self.assertTrue(2.0 <= axes["clearance_mm"] <= 11.8)
            self.assertTrue(0.0 <= axes["tension_N"] <= 30.0)
            self.assertGreater(axes["stretch_N"], 0.0)
            if axes["contact"] == "same-index":
                self.assertEqual(axes["vessel_nodes"], axes["wire_nodes"])

    def test_every_axis_is_met(self):
        for axis, least in (("dimension", 2), ("shape", 5), ("kinematics", 4), ("contact", 3), ("gap", 2), ("length", 2),
                            ("span", 2), ("lumen", 2), ("load", 3), ("rows", 2)):
            self.assertGreaterEqual(len({scene.axes[axis] for scene in self.drawn}), least, axis)

    def test_a_continuation_goes_to_the_scenes_tension_or_to_more_rows_of_a_segment(self):
        plain = sum("[continuation]" in scene.text for scene in self.drawn)
        self.assertEqual(plain, 0)
        walked = [drawing.draw(3, number, continuation=True) for number in range(SCENES)]
        self.assertEqual(sum("[continuation]" in scene.text for scene in walked),
                         sum(scene.axes["tension_N"] > 0.05 or scene.axes["contact"] == "segment-wise" for scene in walked))
        self.assertTrue(all("rows-per-segment" in scene.text for scene in walked
                            if scene.axes["contact"] == "segment-wise"))

    def test_what_is_taken_away(self):
        for number, flaw in enumerate(drawing.UNPOSED):
            scene = drawing.draw(1, number, "unposed")
            self.assertEqual(scene.axes["group"], flaw)
            self.assertEqual('type = "anchoring"' in scene.text, flaw != "no-foundation")
            self.assertEqual(scene.axes["stretch_N"] == 0.0, flaw == "no-stretch")
            self.assertEqual(scene.axes["tension_N"] < 0.0, flaw == "push")
            self.assertEqual(scene.axes["clearance_mm"] < 0.02, flaw == "no-clearance")

    def test_one_scene_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.toml"
            self.assertEqual(random_scenes.main(["--seed", "3", "--scene", "7", "--write", str(file)]), 0)
            self.assertEqual(file.read_text(), self.drawn[7].text)


class Counting(unittest.TestCase):
    def broken(self, share=None, *rows):
        return [found[0] for found in random_scenes.broken_promises(list(rows), share)]

    def test_a_good_row_breaks_nothing(self):
        self.assertEqual(self.broken(1.0, row()), [])

    def test_each_promise(self):
        self.assertEqual(self.broken(None, row(rejected="exit 1: said")), ["rejected by the re-check"])
        self.assertEqual(self.broken(None, row(not_finite="energy.total")), ["a number that is not finite"])
        self.assertEqual(self.broken(None, row(status="crashed", reason="exit -11")), ["crashed"])
        self.assertEqual(self.broken(None, row(status="killed", process_s=110.0)), ["killed"])
        self.assertEqual(self.broken(None, row(process_s=61.0)), ["over 60 s"])
        self.assertEqual(self.broken(None, row(status="refused", group="posed")), ["refused"])
        self.assertEqual(self.broken(None, row(status="refused", group="no-clearance")), [])
        self.assertEqual(self.broken(None, row(status="stalled")), [])
        self.assertEqual(self.broken(0.98, row(), row(status="stalled")), ["too few converge"])

    def test_a_hundred_may_miss_two(self):
        rows = [row(status="stalled" if k < 2 else "converged") for k in range(100)]
        self.assertEqual(self.broken(0.98, *rows), [])
        self.assertEqual(self.broken(0.98, *rows[:99], row(status="stalled")), ["too few converge"])

    def test_numbers_that_are_none_are_found(self):
        self.assertEqual(random_scenes.not_finite({"a": [1.0, {"b": None}]}), "a.1.b")
        self.assertEqual(random_scenes.not_finite({"a": [1.0, float("nan")]}), "a.1")
        self.assertIsNone(random_scenes.not_finite({"a": [1.0, 2], "b": "text"}))

    def test_numbers_of_scenes(self):
        self.assertEqual(random_scenes.parse_numbers("3,8-10"), [3, 8, 9, 10])

    def test_a_report_renders(self):
        rows = [row(), row(status="stalled", reason="at 12.5 mm no more progress", solver="interior-point")]
        text = random_scenes.summarise(rows, [["killed", "active-set", "x", "late"]]).text(markdown=True)
        self.assertIn("1 / 1 = 100.00 %", text)
        self.assertIn("stalled: at mm no more progress", text)
        self.assertIn("| killed | active-set | x | late |", text)


if __name__ == "__main__":
    tests = unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__])
    outcome = unittest.TextTestRunner().run(tests)
    wrong = len(outcome.failures) + len(outcome.errors)
    print(f"{outcome.testsRun - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)
