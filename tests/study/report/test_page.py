"""Opens fabricated reports in a headless browser and looks at what the page makes of them.

    python3 test_page.py WRITE_REPORT_PAGE --out FOLDER

Screenshots of both widths and colour schemes are left in FOLDER. Exits with 77 where there is no browser, unless
BOWSTRING_TEST_BROWSER=1 demands one. Prints 'N passed, N failed'."""

import argparse
import csv
import io
import json
import os
import pathlib
import statistics
import subprocess
import sys
import unittest

import browser as browsers
import fabricate_reports

SKIPPED = 77
WIDTHS, SCHEMES = (1280, 420), ("light", "dark")
DRAWN = "document.documentElement.dataset.ready === 'true'"

PAGE = "const { figures, view, sections, report } = bowstringReport;"
PRESS = "const press = (holder, text) => [...holder.querySelectorAll('button')].find((one) => one.textContent === text).click();"
POINTS = "figures[arguments[0]].chart.data.datasets.flatMap((set) => set.data.map(({ x, y, run, rim }) => ({ x, y, run, rim, line: set.line })))"

OPENED = """const opened = async (figure) => {
    const data = figures[figure].root.querySelector('.data');
    const filled = data.open ? null : new Promise((done) => data.addEventListener('toggle', done, { once: true }));
    data.open = true;
    await filled;
    return data;
};"""


class Page(unittest.TestCase):
    """A page of one report, opened once for all its cases."""

    name = None  # of the report

    @classmethod
    def setUpClass(cls):
        if cls is Page:
            raise unittest.SkipTest("has no report of its own")
        cls.report = fabricate_reports.REPORTS[cls.name]()
        data, page = OUT / f"{cls.name}.json", OUT / f"{cls.name}.html"
        data.write_text(json.dumps(cls.report), encoding="utf-8")
        subprocess.run([WRITE_REPORT_PAGE, data, page], check=True)
        cls.address = page.resolve().as_uri()

    def setUp(self):
        self.show(1280, "light")

    def show(self, width, scheme):
        BROWSER.resize(width, 800)
        BROWSER.prefer(scheme)
        BROWSER.log("browser")
        BROWSER.requests()
        BROWSER.open(self.address)
        BROWSER.wait_for(DRAWN)

    def tearDown(self):
        BROWSER.run("bowstringReport.drawAll();")
        self.assertEqual(BROWSER.log("browser"), [])
        self.assertEqual(BROWSER.run("return document.documentElement.dataset.errors;"), "0")
        requests = BROWSER.requests()
        self.assertIn(self.address, requests)
        self.assertEqual([one for one in requests if one != self.address and not one.startswith(("data:", "blob:"))], [])

    def ask(self, script, *arguments):
        return BROWSER.run(PAGE + script, *arguments)

    def points(self, figure):
        """What a chart of runs holds: {run: point}."""
        points = self.ask(f"return {POINTS};", figure)
        self.assertEqual(len({point["run"] for point in points}), len(points))
        return {point["run"]: point for point in points}

    def rows(self):
        """The numbers of the runs that the table lists, in its order."""
        return self.ask("bowstringReport.drawAll(); return bowstringReport.listedRuns();")

    def data_table(self, figure):
        """The data of a figure as the reader sees it."""
        script = """const data = await opened(arguments[0]);
            return [...data.querySelectorAll('tr')].map((row) => [...row.cells].map((cell) => cell.textContent));"""
        return self.ask(OPENED + f"return (async () => {{ {script} }})();", figure)

    def data_file(self, figure):
        """The file that its button downloads."""
        script = """const data = await opened(arguments[0]);
            const own = URL.createObjectURL;
            let saved = null;
            URL.createObjectURL = (blob) => { saved = blob; return own.call(URL, blob); };
            data.querySelector('.download').click();
            URL.createObjectURL = own;
            return await saved.text();"""
        text = self.ask(OPENED + f"return (async () => {{ {script} }})();", figure)
        return list(csv.DictReader(io.StringIO(text, newline="")))

    def sections(self):
        return self.ask("return sections.map(({ id }) => id);")

    def looks_right_at_every_width_and_scheme(self):
        grounds = {}
        for width in WIDTHS:
            for scheme in SCHEMES:
                with self.subTest(width=width, scheme=scheme):
                    self.show(width, scheme)
                    BROWSER.screenshot(OUT / f"{self.name}-{width}-{scheme}-first.png")
                    self.ask("bowstringReport.drawAll();")
                    self.assertEqual(self.ask("return document.documentElement.scrollWidth;"), width)
                    grounds[scheme] = self.ask("return getComputedStyle(document.body).backgroundColor;")
                    BROWSER.screenshot(OUT / f"{self.name}-{width}-{scheme}.png", whole=True)
        self.assertEqual(len(set(grounds.values())), len(SCHEMES))


class Convergence(Page):
    name = "convergence"

    def test_looks(self):
        self.looks_right_at_every_width_and_scheme()

    def test_the_first_screen_says_what_to_use_and_what_keeps_runs_from_converging(self):
        for selector in (".headline.recommendation .text", ".headline.convergence .text", "#main-figure canvas"):
            box = self.ask("const { top, bottom, height } = document.querySelector(arguments[0]).getBoundingClientRect(); return { top, bottom, height };", selector)
            self.assertGreater(box["height"], 0, selector)
            self.assertLess(box["bottom"], 800, selector)
        first = self.ask("return document.querySelector('.headline').textContent;")
        self.assertIn(self.report["headlines"][0]["text"], first)
        self.assertEqual(self.ask("return document.querySelectorAll('#headlines > .headline').length;"), 4)

    def test_the_main_diagram_holds_cost_and_error_of_every_run(self):
        points = self.points("main")
        errors, runs = self.report["quantities"][0]["errors"], self.report["runs"]
        line_of = {run: index for index, line in enumerate(self.report["lines"]) for run in line["runs"]}
        self.assertEqual(set(points), {run for run, seconds in enumerate(runs["solve_seconds"]) if seconds is not None})
        rims = 0
        for run, point in points.items():
            self.assertEqual(point["x"], runs["solve_seconds"][run])
            self.assertEqual(point["line"], line_of[run])
            if errors[run] is None:
                self.assertEqual(point["rim"], "upper")
                rims += 1
            else:
                self.assertEqual(point["y"], abs(errors[run]))
        self.assertGreater(rims, 0)
        self.assertIn(f"{rims} failures without a value", self.ask("return figures.main.note.textContent;"))

    def test_what_did_not_converge_is_crossed(self):
        kinds = self.ask("return figures.main.chart.data.datasets.flatMap((set) => set.data.map(({ run }) => [run, set.pointStyle === 'crossRot']));")
        self.assertGreater(sum(crossed for _, crossed in kinds), 0)
        for run, crossed in kinds:
            self.assertEqual(crossed, self.report["runs"]["status"][run] != "converged")

    def test_another_cost(self):
        self.ask("const pick = figures.main.tools.querySelector('select'); pick.value = 'unknowns'; pick.dispatchEvent(new Event('change'));")
        for run, point in self.points("main").items():
            self.assertEqual(point["x"], self.report["runs"]["unknowns"][run])
        self.assertEqual(self.ask("return figures.main.chart.options.scales.x.title.text;"), "Unknowns")

    def test_errors_along_the_mesh_and_their_orders(self):
        self.ask("bowstringReport.drawAll();")
        meshes, errors = self.report["axes"][0], self.report["quantities"][0]["errors"]
        points = self.points("convergence")
        self.assertEqual(len(points), len(errors))
        for run, point in points.items():
            self.assertEqual(point["x"], meshes["numbers"][self.report["runs"]["choice"][0][run]])
            if errors[run] is not None:
                self.assertEqual(point["y"], abs(errors[run]))
        scales = self.ask("const { x, y } = figures.convergence.chart.scales; return [x.type, y.type, x.ticks.map(({ label }) => label)];")
        self.assertEqual(scales, ["logarithmic", "logarithmic", [str(number) for number in meshes["numbers"]]])
        table = self.ask("return [...document.querySelectorAll('.orders tbody tr')].map((row) => [...row.cells].map((cell) => cell.textContent));")
        self.assertEqual([row[0] for row in table], [line["label"] for line in self.report["lines"]])
        self.assertEqual(table[4][1:5], ["✓ converges", "2", "1.96 to 2.07", "11.8"])
        self.assertEqual(table[0][1:5], ["✕ does not settle", "–", "–", "–"])

    def test_a_quantity_without_reference_is_shown_against_the_mesh(self):
        self.ask("const pick = document.querySelector('#controls select'); pick.value = '1'; pick.dispatchEvent(new Event('change')); bowstringReport.drawAll();")
        values = self.report["quantities"][1]["values"]
        for figure in ("main", "convergence"):
            own = {run: point["y"] for run, point in self.points(figure).items() if not point.get("rim")}
            self.assertEqual(own, {run: value for run, value in enumerate(values) if value is not None})
        self.assertEqual(self.ask("return figures.main.chart.options.scales.y.title.text;"), "Contact force (N)")

    def test_filters_change_what_is_shown_everywhere(self):
        filters = "const boxes = [...document.querySelectorAll('#controls .filter')].map((one) => [...one.querySelectorAll('input')]);"
        self.ask(filters + "boxes[1][0].click(); boxes[3][0].click(); bowstringReport.drawAll();")
        runs = self.report["runs"]
        left = [run for run, status in enumerate(runs["status"]) if runs["choice"][1][run] != 0 and status != "converged"]
        self.assertGreater(len(left), 0)
        self.assertEqual(self.rows(), left)
        self.assertTrue(set(self.points("main")) <= set(left))
        self.assertIn(f"{len(left)} of 36 runs", self.ask("return document.querySelector('.shown-count').textContent;"))
        self.assertIn(f"{len(left)} runs of {len(left)}", self.ask("return figures.failures.heading.textContent;"))
        self.ask("document.querySelector('.reset').click();")
        self.assertEqual(len(self.rows()), 36)

    def test_the_legend_hides_a_formulation(self):
        self.ask("figures.main.legend.querySelector('.entry').focus(); figures.main.legend.querySelector('.entry').click();")
        hidden = self.report["headlines"][0]["lines"][0]
        self.assertEqual(self.ask("return figures.main.legend.querySelector('.entry').getAttribute('aria-pressed');"), "false")
        self.assertTrue(self.ask("return document.activeElement === figures.main.legend.querySelector('.entry');"))
        self.assertNotIn(hidden, {point["line"] for point in self.points("main").values()})
        self.assertEqual(set(range(36)) - set(self.rows()), set(self.report["lines"][hidden]["runs"]))

    def test_sorting(self):
        head = "const heads = [...document.querySelectorAll('#runs th')]; const head = heads.find((one) => one.textContent === arguments[0]);"
        values = self.report["quantities"][0]["values"]
        known = sorted((run for run in range(36) if values[run] is not None), key=lambda run: values[run])
        unknown = [run for run in range(36) if values[run] is None]
        self.ask(head + "head.querySelector('button').click();", "peak displacement (mm)")
        self.assertEqual(self.rows(), known + unknown)
        self.assertEqual(self.ask(head + "return head.ariaSort;", "peak displacement (mm)"), "ascending")
        self.ask(head + "head.querySelector('button').click();", "peak displacement (mm)")
        self.assertEqual([values[run] for run in self.rows()], [values[run] for run in reversed(known)] + [None] * len(unknown))
        self.assertEqual(self.ask(head + "return [head.ariaSort, heads[0].ariaSort];", "peak displacement (mm)"), ["descending", "none"])

    def test_finding_text(self):
        self.ask("const field = document.querySelector('#runs input'); field.value = 'Working Set'; field.dispatchEvent(new Event('input'));")
        self.assertEqual(self.rows(), [run for run, reason in enumerate(self.report["runs"]["reason"]) if "working set" in reason])

    def test_a_click_on_a_row_marks_its_run(self):
        before = self.ask("bowstringReport.drawAll(); return figures.main.box.querySelector('canvas').toDataURL();")
        self.ask("document.querySelector('#runs tbody tr[aria-rowindex=\"8\"]').click();")
        self.assertEqual(self.ask("return view.selected;"), 6)
        self.assertIn("Run 6: N 40", self.ask("return document.querySelector('.selected').textContent;"))
        self.assertNotEqual(self.ask("return figures.main.box.querySelector('canvas').toDataURL();"), before)

    def test_the_data_of_a_plot_is_what_it_shows(self):
        table = self.data_table("main")
        column = table[0].index("error")
        errors = self.report["quantities"][0]["errors"]
        self.assertEqual(len(table) - 1, len(self.points("main")))
        for row in table[1:]:
            error = errors[int(row[0])]
            if error is None:
                self.assertEqual(row[column], "–")
            else:
                self.assertAlmostEqual(float(row[column].replace("−", "-")) / abs(error), 1, places=5)
        file = self.data_file("main")
        self.assertEqual(len(file), len(table) - 1)
        for row in file:
            error = errors[int(row["run"])]
            self.assertEqual(row["error"] and float(row["error"]), "" if error is None else abs(error))
            self.assertEqual(row["formulation"], self.report["lines"][self.points("main")[int(row["run"])]["line"]]["label"])

    def test_the_heat_map_holds_medians_and_marks_failures(self):
        self.ask("bowstringReport.drawAll();")
        values, runs = self.report["quantities"][0]["values"], self.report["runs"]
        rows = self.data_file("heat-map")
        self.assertEqual(len(rows), 18)
        for row in rows:
            own = [run for run in range(36) if self.report["axes"][0]["numbers"][runs["choice"][0][run]] == float(row["N"])
                   and self.report["axes"][1]["labels"][runs["choice"][1][run]] == row["contact"]]
            good = [run for run in own if runs["status"][run] == "converged"]
            self.assertEqual(int(row["not converged"]), len(own) - len(good))
            median = row["peak displacement (mm)"]
            if good:
                self.assertAlmostEqual(float(median), statistics.median(values[run] for run in good), places=12)
            else:
                self.assertEqual(median, "")
        marks = self.ask("return ['all-failed', 'some-failed'].map((kind) => document.querySelectorAll(`.heat td.${kind}`).length);")
        self.assertEqual(marks, [sum(row["not converged"] == "2" for row in rows), sum(row["not converged"] == "1" for row in rows)])
        self.assertGreater(min(marks), 0)

    def test_effects_largest_first_and_in_words(self):
        self.ask("bowstringReport.drawAll();")
        means = self.ask("return figures.effects.chart.data.datasets[0].data.map(({ x }) => x);")
        self.assertEqual(means, [effect["mean"] for effect in self.report["effects"]])
        self.assertIn("contact from same-index-contact to segment-wise-contact, by −1.9 mm", self.ask("return document.querySelector('.lead').textContent;"))

    def test_energies_are_of_the_finest_run_of_each_formulation(self):
        self.ask("bowstringReport.drawAll();")
        terms = self.ask("return figures.energies.chart.data.datasets.map(({ label, data }) => [label, data.map(({ x, run }) => [run, x])]);")
        energies = self.report["energies"]
        finest = [[run for run in line["runs"] if energies[0]["values"][run] is not None][-1] for line in self.report["lines"]]
        self.assertEqual(terms, [[energy["term"], [[run, energy["values"][run]] for run in finest]] for energy in energies])

    def test_shapes_are_drawn_to_one_scale_with_their_forces(self):
        self.ask("bowstringReport.drawAll();")
        count = "return ['.wire', '.vessel', '.rest', '.force'].map((kind) => document.querySelectorAll(`.shapes ${kind}`).length);"
        self.assertEqual(self.ask(count), [3, 3, 3, 9])
        matrix = self.ask("const { a, b, c, d } = document.querySelector('svg.shapes').getScreenCTM(); return [a, b, c, d];")
        self.assertAlmostEqual(matrix[0], matrix[3])
        self.ask("figures.shapes.legend.querySelector('.entry').click(); bowstringReport.drawAll();")
        self.assertEqual(self.ask(count), [2, 2, 2, 6])
        rows = [row for row in self.data_file("shapes") if row["kind"] == "wire"]
        points = [point for shape in self.report["shapes"][1:] for point in shape["curves"][1]["points"]]
        self.assertEqual([[float(row["x (mm)"]), float(row["y (mm)"])] for row in rows], points)

    def test_every_failure_is_counted_with_its_reason(self):
        self.ask("bowstringReport.drawAll();")
        groups = self.ask("return [...document.querySelectorAll('.failures-table tbody tr')].map((row) => [...row.cells].map((cell) => cell.textContent));")
        runs = self.report["runs"]
        self.assertEqual(sum(int(group[0]) for group in groups), sum(status != "converged" for status in runs["status"]))
        for count, status, reason, _ in groups:
            self.assertEqual(int(count), sum(one == (status, reason) for one in zip(runs["status"], runs["reason"])))

    def test_the_scheme_can_be_chosen(self):
        scheme = "return [document.getElementById('scheme').textContent, document.documentElement.dataset.scheme];"
        self.assertEqual(self.ask(scheme), ["Scheme: automatic", "light"])
        self.ask("document.getElementById('scheme').click(); document.getElementById('scheme').click();")
        self.assertEqual(self.ask(scheme), ["Scheme: dark", "dark"])
        colour = self.ask("return figures.main.chart.options.scales.x.ticks.color;")
        self.ask("document.getElementById('scheme').click();")
        self.assertEqual(self.ask(scheme), ["Scheme: automatic", "light"])
        self.assertNotEqual(self.ask("return figures.main.chart.options.scales.x.ticks.color;"), colour)

    def test_one_global_and_headings_in_order(self):
        own = self.ask("""const clean = document.body.appendChild(document.createElement('iframe'));
            const names = Object.keys(window).filter((name) => isNaN(name) && !(name in clean.contentWindow));
            clean.remove();
            return names;""")
        self.assertEqual([name for name in own if name != "ret_nodes"], ["bowstringReport"])  # that one is the driver's
        levels = self.ask("bowstringReport.drawAll(); return [...document.querySelectorAll('h1, h2, h3, h4')].map((one) => [one.tagName, one.textContent]);")
        self.assertEqual(levels[0][0], "H1")
        self.assertEqual([text for _, text in levels if not text], [])
        self.assertEqual(self.ask("return [...document.querySelectorAll('input, select')].filter((one) => !one.labels.length).length;"), 0)


class Sample(Page):
    name = "sample"

    def test_looks(self):
        self.looks_right_at_every_width_and_scheme()

    def test_the_first_screen_shows_the_most_influential_parameter(self):
        numbers, values = self.report["axes"][1]["numbers"], self.report["quantities"][0]["values"]
        points = self.points("main")
        self.assertEqual(len(points), 200)
        for run, point in points.items():
            self.assertEqual(point["x"], numbers[run])
            self.assertEqual(point["y"] if values[run] is not None else None, values[run])

    def test_no_point_lies_outside_its_plot(self):
        self.ask("bowstringReport.drawAll();")
        for figure in ("main", "scatter"):
            outside = self.ask(f"const {{ x, y }} = figures[arguments[0]].chart.scales; return {POINTS}.filter((one) => one.x < x.min || one.x > x.max || one.y < y.min || one.y > y.max).length;", figure)
            self.assertEqual(outside, 0, figure)

    def test_histogram_quantiles_and_shares(self):
        self.ask("bowstringReport.drawAll();")
        distribution = self.report["distributions"][0]
        bins = self.ask("return figures.histogram.chart.data.datasets[0].data.map(({ low, high, y }) => [low, high, y]);")
        self.assertEqual(sum(count for _, _, count in bins), distribution["count"])
        values = [value for value in self.report["quantities"][0]["values"] if value is not None]
        self.assertAlmostEqual(bins[0][0], min(values))
        self.assertAlmostEqual(bins[-1][1], max(values))
        row = self.ask("return [...document.querySelectorAll('#distribution .scroll td')].slice(0, 8).map((cell) => cell.textContent);")
        self.assertEqual(int(row[0]), distribution["count"])
        for text, (_, value) in zip(row[3:], distribution["quantiles"]):
            self.assertAlmostEqual(float(text), value, places=3)
        self.assertEqual(self.ask("return document.querySelector('.share-bars').textContent;"), "EI86 %T12 %")

    def test_a_number_filters_by_its_bounds(self):
        self.ask("const field = document.querySelectorAll('#controls .bounds input')[1]; field.value = '5'; field.dispatchEvent(new Event('change'));")
        tension = self.report["axes"][0]["numbers"]
        self.assertEqual(self.rows(), [run for run in range(200) if tension[run] <= 5])

    def test_sensitivities_and_what_cannot_be_told_apart(self):
        self.ask("bowstringReport.drawAll();")
        text = self.ask("return document.getElementById('sensitivities').textContent;")
        self.assertIn("T and EI cannot be told apart", text)
        self.assertIn("0.0021 mm/(N mm²)", text)

    def test_a_section_without_data_does_not_appear(self):
        self.assertEqual(self.sections(), ["distribution", "sensitivities", "failures", "runs"])


class Ablation(Page):
    name = "ablation"

    def test_looks(self):
        self.looks_right_at_every_width_and_scheme()

    def test_the_first_screen_shows_effects(self):
        self.assertEqual(self.ask("return figures.main.chart.data.datasets[0].data.map(({ x }) => x);"),
                         [effect["mean"] for effect in self.report["effects"]])

    def test_names_are_text(self):
        self.ask("bowstringReport.drawAll();")
        self.assertEqual(self.ask("return document.querySelector('h1').textContent;"), self.report["study"]["title"])
        self.assertIn(fabricate_reports.HOSTILE, self.ask("return document.querySelector('.headline .text').textContent;"))
        self.assertEqual(self.ask("return document.querySelector('#controls .filter b').textContent;"), fabricate_reports.HOSTILE)
        self.assertEqual(self.ask("return document.querySelectorAll('td i, th i, h1 b').length;"), 0)
        self.assertIn("<i>none</i>", self.ask("return document.getElementById('runs').textContent;"))
        self.assertEqual(self.ask("return report;"), self.report)

    def test_a_long_detail_shows_its_beginning(self):
        self.assertTrue(self.ask("const text = document.querySelector('.clamped'); return text.scrollHeight > text.clientHeight;"))
        self.ask("document.querySelector('.headline button').click();")
        self.assertEqual(self.ask("return document.querySelectorAll('.clamped').length;"), 0)


class Failures(Page):
    name = "failures"

    def test_looks(self):
        self.looks_right_at_every_width_and_scheme()

    def test_how_the_runs_ended_is_what_is_shown(self):
        self.assertEqual(self.sections(), ["heat-map", "failures", "runs"])
        text = self.ask("return figures.main.root.textContent;")
        self.assertIn("3 diverged", text)
        self.assertIn("3 refused: nlopt: found 2 equalities", text)
        self.assertEqual(len(self.rows()), 6)


class Large(Page):
    name = "large"

    def test_looks(self):
        self.looks_right_at_every_width_and_scheme()

    def test_opening(self):
        times = []
        for _ in range(3):
            self.show(1280, "light")
            times.append(self.ask("return bowstringReport.readyAfter;"))
        rest = self.ask("const before = performance.now(); bowstringReport.drawAll(); return performance.now() - before;")
        print(f"\n10 000 runs: ready after {', '.join(f'{time:.0f}' for time in times)} ms, every section {rest:.0f} ms more, "
              f"{(OUT / 'large.html').stat().st_size / 1e6:.1f} MB")
        self.assertEqual(len(self.rows()), 10000)

    def test_what_is_below_the_fold_waits(self):
        self.assertIsNone(self.ask("return figures.energies.chart;"))

    def test_only_rows_in_sight_are_elements(self):
        self.ask("bowstringReport.drawAll();")
        numbers = "return [...document.querySelectorAll('#runs tbody tr[aria-rowindex]')].map((row) => Number(row.cells[0].textContent));"
        first = self.ask(numbers)
        self.assertIn(0, first)
        self.assertLess(len(first), 100)
        self.ask("const frame = document.querySelector('.rows'); frame.scrollTop = frame.scrollHeight; frame.dispatchEvent(new Event('scroll'));")
        last = self.ask(numbers)
        self.assertIn(9999, last)
        self.assertLess(len(last), 100)

    def test_a_crowd_is_thinned_and_that_is_said(self):
        points = self.ask(f"return {POINTS}.length;", "main")
        self.assertGreater(points, 1000)
        self.assertLessEqual(points, 4200)
        self.assertIn("of 500 formulations", self.ask("return figures.main.note.textContent;"))
        recommended = self.report["headlines"][0]["lines"][0]
        self.assertIn(recommended, self.ask("return figures.main.chart.data.datasets.map(({ line }) => line);"))

    def test_a_long_legend_is_cut(self):
        count = "return figures.main.legend.querySelectorAll('.entry').length;"
        self.assertEqual(self.ask(count), 24)
        self.ask(PRESS + "press(figures.main.legend, 'and 476 more');")
        self.assertEqual(self.ask(count), 500)


def main():
    global WRITE_REPORT_PAGE, OUT, BROWSER
    parser = argparse.ArgumentParser()
    parser.add_argument("write_report_page")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    options, others = parser.parse_known_args()
    missing = browsers.missing()
    if missing:
        print(f"there is no {' and no '.join(missing)}; install the packages chromium and chromium-driver")
        return 1 if os.environ.get("BOWSTRING_TEST_BROWSER") == "1" else SKIPPED
    WRITE_REPORT_PAGE, OUT = options.write_report_page, options.out
    OUT.mkdir(parents=True, exist_ok=True)
    with browsers.Browser() as BROWSER:
        result = unittest.main(argv=[sys.argv[0], *others], exit=False).result
    bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - bad} passed, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
