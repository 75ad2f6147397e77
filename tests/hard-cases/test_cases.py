"""The hard-case runner's own functions: reading of case files, substitution, judgement of documents. Prints
'N passed, N failed'."""

import contextlib
import io
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import cases
import hard_cases

CASE = '''
why = "because"
composition = "{composition}"
{more}
[[run]]
name = "EI"
each = ["1", "2"]
set = {{ "energy.wire-bending.bending-stiffness" = "{{each}} N mm^2" }}
verdict = ["converged", "invalid"]
expect = {{ "energy.total" = {{ value = 3.0, relative = 0.1 }} }}
known-shortfall = [{{ solver = "active-set", each = ["2"], happens = "stalled" }}]
'''


class Folder(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def read(self, text):
        file = self.folder / "case.toml"
        file.write_text(text, encoding="utf-8")
        return cases.Reader(self.folder / "written").case(file)

    def refused(self, text, *expected):
        with self.assertRaises(cases.WrongCase) as caught:
            self.read(text)
        for part in expected:
            self.assertIn(part, str(caught.exception))


class Reading(Folder):
    def test_each_value_makes_a_run_and_takes_its_marks(self):
        case = self.read(CASE.format(composition="x.toml", more=""))
        self.assertEqual([run.name for run in case.runs], ["EI 1", "EI 2"])
        self.assertEqual(case.runs[1].scene.overrides, (("energy.wire-bending.bending-stiffness", "2 N mm^2"),))
        self.assertEqual(case.runs[0].shortfalls, {})
        self.assertEqual(case.runs[1].shortfalls, {"active-set": "stalled"})

    def test_unknown_keys_are_named(self):
        self.refused(CASE.format(composition="x.toml", more="colour = 1"), "unknown key 'colour'", "expected one of")
        self.refused('composition = "x.toml"\n[[run]]\nname = "a"\nverdict = "converged"', "'why' is missing")

    def test_agreements_name_runs(self):
        text = CASE.format(composition="x.toml", more="") + '[[agree]]\nruns = ["EI 3"]\npath = "energy.total"\n'
        self.refused(text, "'EI 3'", "EI 1, EI 2")

    def test_runs_have_names_of_their_own(self):
        text = CASE.format(composition="x.toml", more="")
        self.refused(text + text[text.index("[[run]]"):], "two runs are called 'EI")

    def test_spacings_sum_to_one_and_differ_by_their_ratio(self):
        for name in ("geometric", "alternating"):
            fractions = cases.SPACINGS[name](79, 1e4)
            self.assertAlmostEqual(sum(fractions), 1.0, 12)
            self.assertAlmostEqual(max(fractions) / min(fractions), 1e4, 6)
        text = cases.Reader(self.folder).filled("{alternating:3:2}", "", "")
        self.assertEqual(text, "[0.40000000000000002, 0.20000000000000001, 0.40000000000000002]")

    def test_repeated_points_are_dropped(self):
        source, target = self.folder / "a.csv", self.folder / "b.csv"
        source.write_text("# note\nx_mm,y_mm,z_mm,radius_mm\n0,0,0,1\n0,0,0,1.1\n1,0,0,2\n", encoding="utf-8")
        cases.without_repeated_points(source, target)
        self.assertEqual(target.read_text(encoding="utf-8"), "x_mm,y_mm,z_mm,radius_mm\n0,0,0,1\n1,0,0,2\n")

    def test_without_data_a_case_says_why_it_is_skipped(self):
        with mock.patch.dict(os.environ):
            os.environ.pop(cases.scenes.DATA, None)
            case = self.read(CASE.format(composition="x.toml", more='data = "a/{{each}}.csv"'.replace("{{", "{")
                                         .replace("}}", "}")))
        self.assertIn(cases.scenes.DATA, case.skip)

    def test_every_case_beside_this_program_reads(self):
        files = sorted(cases.HERE.glob("*.toml"))
        self.assertGreater(len(files), 15)
        for file in files:
            case = cases.Reader(self.folder / "written").case(file)
            self.assertGreater(len(case.why), 100)
            self.assertIn(f"'{file.stem}'", (cases.HERE / "meson.build").read_text(encoding="utf-8"))


class Judging(Folder):
    def setUp(self):
        super().setUp()
        self.run_ = self.read(CASE.format(composition="x.toml", more="")).runs[0]

    def row(self, status, solver="interior-point", reason=""):
        return {"status": status, "reason": reason, "solver": solver, "iterations": 3, "solve_s": 0.1}

    def test_figures_are_demanded_of_the_first_verdict_alone(self):
        faults = cases.faults
        self.assertEqual(faults(self.run_, self.row("converged"), {"energy": {"total": 3.1}}), [])
        self.assertIn("energy.total = 4, expected 3",
                      faults(self.run_, self.row("converged"), {"energy": {"total": 4.0}})[0])
        self.assertIn("not in the result", faults(self.run_, self.row("converged"), {"energy": {}})[0])
        self.assertEqual(faults(self.run_, self.row("invalid"), {"energy": {"total": 9.0}}), [])
        self.assertIn("stalled, expected converged or invalid", faults(self.run_, self.row("stalled"), {})[0])
        self.assertIn("crashed", faults(self.run_, self.row("crashed"), None)[0])

    def test_places_that_fall_back_are_found(self):
        self.assertEqual(cases.first_fall([1.0, None, 2.0]), "")
        self.assertIn("entry 2", cases.first_fall([1.0, 3.0, 2.0]))
        self.assertNotEqual(cases.first_fall([]), "")
        self.assertEqual(cases.looked_up({"contacts": [{"s": 1}, {"s": 2}]}, "contacts.*.s"), [1, 2])
        self.assertEqual(cases.looked_up({"a": [1, 2]}, "a.-1"), 2)

    def test_disagreement(self):
        agreement = {"runs": ["a", "b"], "path": "e", "relative": 0.1}
        self.assertEqual(cases.disagreement(agreement, {"a": {"e": 1.0}, "b": {"e": 1.05}}), "")
        self.assertIn("1, 2", cases.disagreement(agreement, {"a": {"e": 1.0}, "b": {"e": 2.0}}))
        self.assertIsNone(cases.disagreement(agreement, {"a": {"e": 1.0}}))

    def judged(self, run, row, document, demanded=True):
        tally = hard_cases.Tally()
        with contextlib.redirect_stdout(io.StringIO()) as said:
            hard_cases.judge(run, row, document, tally, demanded)
        return tally, said.getvalue()

    def test_a_known_shortfall_fails_only_when_it_is_gone(self):
        marked = cases.dataclasses.replace(self.run_, shortfalls={"active-set": "stalled"})
        tally, said = self.judged(marked, self.row("stalled", "active-set"), {})
        self.assertEqual((tally.failed, tally.shortfalls), (0, 1))
        self.assertIn("known: stalled", said)
        tally, said = self.judged(marked, self.row("converged", "active-set"), {"energy": {"total": 3.0}})
        self.assertEqual((tally.failed, tally.shortfalls), (1, 0))
        self.assertIn("take the mark away", said)
        self.assertEqual(self.judged(marked, self.row("stalled"), {})[0].failed, 1)

    def test_a_solver_that_is_not_demanded_is_shown(self):
        tally, said = self.judged(self.run_, self.row("stalled", "ipopt"), {}, demanded=False)
        self.assertEqual((tally.passed, tally.failed), (0, 0))
        self.assertIn("shown", said)


if __name__ == "__main__":
    program = unittest.main(exit=False)
    bad = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - bad} passed, {bad} failed")
    sys.exit(1 if bad else 0)
