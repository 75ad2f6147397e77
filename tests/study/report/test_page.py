"""Opens fabricated reports in a headless browser and looks at what the page makes of them.

    python3 test_page.py WRITE_REPORT_PAGE --out FOLDER [unittest's arguments]

Screenshots of both widths and colour schemes are left in FOLDER. Exits with 77 where there is no browser, unless
BOWSTRING_TEST_BROWSER=1 demands one. Prints 'N passed, N failed'."""

import argparse
import os
import pathlib
import statistics
import sys
import unittest

import browser as browsers
import fabricate_reports
from page import Page

SKIPPED = 77


class Convergence(Page):
    name = "convergence"

    def test_looks(self):
        self.check_looks()

    def test_the_first_screen_says_what_to_use_and_what_keeps_runs_from_converging(self):
        for selector in (".headline.recommendation .text", ".headline.convergence .text", "#main-figure canvas"):
            box = self.value("find(arguments[0]).getBoundingClientRect().toJSON()", selector)
            self.assertGreater(box["height"], 0, selector)
            self.assertLess(box["bottom"], 800, selector)
        self.assertEqual(self.value("text('.headline.first .text')"), self.report["headlines"][0]["text"])
        self.assertEqual(self.value("count('#headlines > .headline')"), 4)

    def test_the_main_diagram_holds_cost_and_error_of_every_run(self):
        errors, seconds = self.report["quantities"][0]["errors"], self.report["runs"]["solve_seconds"]
        line_of = {run: index for index, line in enumerate(self.report["lines"]) for run in line["runs"]}
        points = self.points("main")
        self.assertEqual(set(points), {run for run in range(36) if seconds[run] is not None})
        at_rim = [run for run in points if errors[run] is None]
        self.assertGreater(len(at_rim), 0)
        for run, point in points.items():
            self.assertEqual((point["x"], point["line"]), (seconds[run], line_of[run]))
            self.assertEqual(point.get("rim"), "upper" if run in at_rim else None)
            if run not in at_rim:
                self.assertEqual(point["y"], abs(errors[run]))
        self.assertIn(f"{len(at_rim)} failures without a value", self.value("figures.main.note.textContent"))

    def test_what_did_not_converge_is_crossed(self):
        crossed = self.value("datasets('main').map(({ data, pointStyle }) => [data.map(({ run }) => run), pointStyle])")
        self.assertEqual(sum(style == "crossRot" for _, style in crossed), 5)
        for runs, style in crossed:
            for run in runs:
                self.assertEqual(style == "crossRot", self.report["runs"]["status"][run] != "converged")

    def test_another_cost(self):
        self.do("enter(figures.main.tools.querySelector('select'), 'unknowns', 'change');")
        for run, point in self.points("main").items():
            self.assertEqual(point["x"], self.report["runs"]["unknowns"][run])
        self.assertEqual(self.value("figures.main.chart.options.scales.x.title.text"), "Unknowns")

    def test_errors_along_the_mesh_and_their_orders(self):
        self.do("drawAll();")
        mesh, errors = self.report["axes"][0], self.report["quantities"][0]["errors"]
        points = self.points("convergence")
        self.assertEqual(len(points), 36)
        for run, point in points.items():
            self.assertEqual(point["x"], mesh["numbers"][self.report["runs"]["choice"][0][run]])
            if errors[run] is not None:
                self.assertEqual(point["y"], abs(errors[run]))
        scales = "Object.values(figures.convergence.chart.scales)"
        self.assertEqual(self.value(scales + ".map(({ type }) => type)"), ["logarithmic", "logarithmic"])
        ticks = self.value("figures.convergence.chart.scales.x.ticks.map(({ label }) => label)")
        self.assertEqual(ticks, mesh["labels"])
        table = self.value("cells('.orders tbody tr')")
        self.assertEqual([row[0] for row in table], [line["label"] for line in self.report["lines"]])
        self.assertEqual(table[4][1:5], ["✓ converges", "2", "1.95 to 2.05", "11.8"])
        self.assertEqual(table[0][1:5], ["✕ does not settle", "–", "–", "–"])

    def test_a_quantity_without_reference_is_shown_against_the_mesh(self):
        self.do("enter(find('#controls select'), '1', 'change'); drawAll();")
        values = self.report["quantities"][1]["values"]
        for figure in ("main", "convergence"):
            shown = {run: point["y"] for run, point in self.points(figure).items() if not point.get("rim")}
            self.assertEqual(shown, {run: value for run, value in enumerate(values) if value is not None})
        self.assertEqual(self.value("figures.main.chart.options.scales.y.title.text"), "Contact force (N)")

    def test_filters_change_what_is_shown_everywhere(self):
        self.do("""const box = (filter, index) => all("#controls .filter")[filter].querySelectorAll("input")[index];
            box(1, 0).click(); box(3, 0).click();""")
        contact, status = self.report["runs"]["choice"][1], self.report["runs"]["status"]
        left = [run for run in range(36) if contact[run] != 0 and status[run] != "converged"]
        self.assertGreater(len(left), 0)
        self.assertEqual(self.listed(), left)
        self.assertTrue(set(self.points("main")) <= set(left))
        self.assertEqual(self.value("text('.shown-count')"), f"{len(left)} of 36 runs")
        self.assertIn(f"{len(left)} runs of {len(left)}", self.value("figures.failures.heading.textContent"))
        formulations = {line["label"] for line in self.report["lines"] if set(line["runs"]) & set(left)}
        self.assertEqual({row[0] for row in self.value("cells('.orders tbody tr')")}, formulations)
        self.assertEqual(self.value("figures.main.legend.querySelectorAll('.entry').length"), len(formulations))
        self.assertEqual(self.value("count('.shapes .wire')"), 0)
        self.do("find('.reset').click();")
        self.assertEqual(len(self.listed()), 36)

    def test_nothing_left_is_no_error(self):
        self.do("all('#controls .filter')[0].querySelectorAll('input').forEach((box) => box.click()); drawAll();")
        self.assertEqual(self.listed(), [])
        self.assertEqual(self.points("main"), {})

    def test_the_legend_hides_a_formulation(self):
        recommended = self.report["headlines"][0]["lines"][0]
        entry = "figures.main.legend.querySelector('.entry')"
        self.do(f"{entry}.focus(); {entry}.click();")
        self.assertEqual(self.value(f"{entry}.ariaPressed"), "false")
        self.assertTrue(self.value(f"document.activeElement === {entry}"))
        self.assertNotIn(recommended, {point["line"] for point in self.points("main").values()})
        self.assertEqual(set(range(36)) - set(self.listed()), set(self.report["lines"][recommended]["runs"]))

    def test_sorting(self):
        self.do("drawAll();")
        heads = "all('#runs th').find((head) => head.textContent === 'peak displacement (mm)')"
        values = self.report["quantities"][0]["values"]
        known = sorted((value for value in values if value is not None))
        unknown = [None] * (36 - len(known))
        for direction, ordered in (("ascending", known), ("descending", known[::-1])):
            self.do(f"{heads}.querySelector('button').click();")
            self.assertEqual([values[run] for run in self.listed()], ordered + unknown)
            self.assertEqual(self.value(f"[{heads}.ariaSort, find('#runs th').ariaSort]"), [direction, "none"])

    def test_finding_text(self):
        self.do("drawAll(); enter(find('#runs input'), 'Working Set', 'input');")
        reasons = self.report["runs"]["reason"]
        self.assertEqual(self.listed(), [run for run in range(36) if "working set" in reasons[run]])

    def test_a_click_on_a_row_marks_its_run_in_the_plots(self):
        picture = "figures.main.box.querySelector('canvas').toDataURL()"
        self.do("drawAll();")
        before = self.value(picture)
        self.do("find('#runs tbody tr[aria-rowindex=\"8\"]').click();")
        self.assertEqual(self.value("view.selected"), 6)
        self.assertIn("Run 6: N 40", self.value("text('.selected')"))
        self.assertNotEqual(self.value(picture), before)

    def test_a_click_on_a_point_marks_its_run_in_the_table(self):
        place = self.do("""const { chart } = figures.main;
            const { x, y } = chart.getDatasetMeta(0).data[2];
            const box = chart.canvas.getBoundingClientRect();
            return [box.x + x, box.y + y, datasets("main")[0].data[2].run];""")
        self.browser.click(*place[:2])
        self.do("drawAll();")
        self.assertEqual(self.value("view.selected"), place[2])
        self.assertEqual(self.value("text('.selected-row button')"), str(place[2]))

    def test_the_data_of_a_plot_are_what_it_shows(self):
        errors, lines = self.report["quantities"][0]["errors"], self.report["lines"]
        points = self.points("main")
        shown, saved = self.shown_data("main"), self.saved_data("main")
        self.assertEqual([row["run"] for row in saved], [row[0] for row in shown[1:]])
        self.assertEqual({int(row["run"]) for row in saved}, set(points))
        for row, words in zip(saved, shown[1:]):
            run, word = int(row["run"]), words[shown[0].index("error")].replace("−", "-")
            self.assertEqual(row["formulation"], lines[points[run]["line"]]["label"])
            if errors[run] is None:
                self.assertEqual((row["error"], word), ("", "–"))
            else:
                self.assertEqual(float(row["error"]), abs(errors[run]))
                self.assertAlmostEqual(float(word) / abs(errors[run]), 1, places=5)

    def test_the_heat_map_holds_medians_and_marks_failures(self):
        self.do("drawAll();")
        mesh, contact = self.report["axes"][0]["numbers"], self.report["axes"][1]["labels"]
        values, runs = self.report["quantities"][0]["values"], self.report["runs"]
        rows = self.saved_data("heat-map")
        self.assertEqual(len(rows), 18)
        for row in rows:
            own = [run for run in range(36) if mesh[runs["choice"][0][run]] == float(row["N"])
                   and contact[runs["choice"][1][run]] == row["contact"]]
            good = [values[run] for run in own if runs["status"][run] == "converged"]
            self.assertEqual(int(row["not converged"]), len(own) - len(good))
            median = row["peak displacement (mm)"]
            self.assertEqual(float(median) if median else None, statistics.median(good) if good else None)
        for kind, failed in (("all-failed", "2"), ("some-failed", "1")):
            marked = self.value("count(arguments[0])", f".heat td.{kind}")
            self.assertGreater(marked, 0)
            self.assertEqual(marked, sum(row["not converged"] == failed for row in rows))

    def test_a_heat_map_of_statuses(self):
        self.do("drawAll();")
        self.do("enter(figures['heat-map'].tools.querySelectorAll('select')[2], 'status', 'change'); drawAll();")
        row = self.value("cells('.heat tbody tr')")[0]
        self.assertEqual(row, ["same-index-contact", *["converged"] * 4, "1 of 2", "stalled"])

    def test_effects_largest_first_and_in_words(self):
        self.do("drawAll();")
        means = self.value("points('effects').map(({ x }) => x)")
        self.assertEqual(means, [effect["mean"] for effect in self.report["effects"]])
        words = "contact from same-index-contact to segment-wise-contact, by −1.9 mm"
        self.assertIn(words, self.value("text('.lead')"))

    def test_energies_are_of_the_finest_run_of_each_formulation(self):
        self.do("drawAll();")
        recommended = self.report["headlines"][0]["lines"][0]
        lines = sorted(self.report["lines"], key=lambda line: line is not self.report["lines"][recommended])
        for index, energy in enumerate(self.report["energies"]):
            finest = [[run for run in line["runs"] if energy["values"][run] is not None][-1] for line in lines]
            shown = self.value("datasets('energies')[arguments[0]].data.map(({ run, x }) => [run, x])", index)
            self.assertEqual(shown, [[run, energy["values"][run]] for run in finest])
            self.assertEqual(self.value("datasets('energies')[arguments[0]].label", index), energy["term"])

    def test_shapes_are_drawn_to_one_scale_with_their_forces(self):
        self.do("drawAll();")
        counts = "['wire', 'vessel', 'rest', 'force'].map((kind) => count(`.shapes .${kind}`))"
        self.assertEqual(self.value(counts), [3, 3, 3, 9])
        along_x, along_y = self.do("const { a, d } = find('svg.shapes').getScreenCTM(); return [a, d];")
        self.assertGreater(along_x, 0)
        self.assertAlmostEqual(along_x, along_y)
        self.do("figures.shapes.legend.querySelector('.entry').click(); drawAll();")
        self.assertEqual(self.value(counts), [2, 2, 2, 6])
        wires = [row for row in self.saved_data("shapes") if row["kind"] == "wire"]
        points = [point for shape in self.report["shapes"][1:] for point in shape["curves"][1]["points"]]
        self.assertEqual([[float(row["x (mm)"]), float(row["y (mm)"])] for row in wires], points)

    def test_every_failure_is_counted_with_its_reason(self):
        self.do("drawAll();")
        runs = self.report["runs"]
        outcomes = list(zip(runs["status"], runs["reason"]))
        groups = self.value("cells('.failures-table tbody tr')")
        self.assertEqual(sum(int(group[0]) for group in groups), 36 - runs["status"].count("converged"))
        for number, status, reason, _ in groups:
            self.assertEqual(int(number), outcomes.count((status, reason)))

    def test_the_scheme_can_be_chosen(self):
        scheme = "[text('#scheme'), document.documentElement.dataset.scheme]"
        ink = "figures.main.chart.options.scales.x.ticks.color"
        self.assertEqual(self.value(scheme), ["Scheme: automatic", "light"])
        light = self.value(ink)
        self.do("find('#scheme').click(); find('#scheme').click();")
        self.assertEqual(self.value(scheme), ["Scheme: dark", "dark"])
        self.assertNotEqual(self.value(ink), light)
        self.do("find('#scheme').click();")
        self.assertEqual(self.value(scheme), ["Scheme: automatic", "light"])

    def test_one_global(self):
        own = self.do("""const clean = document.body.appendChild(document.createElement("iframe"));
            const names = Object.keys(window).filter((name) => isNaN(name) && !(name in clean.contentWindow));
            clean.remove();
            return names;""")
        self.assertEqual([name for name in own if name != "ret_nodes"], ["bowstringReport"])  # that one is the driver's

    def test_headings_and_labels(self):
        self.do("drawAll();")
        headings = self.value("all('h1, h2, h3, h4').map(({ tagName, textContent }) => [tagName, textContent])")
        self.assertEqual([tag for tag, _ in headings].count("H1"), 1)
        self.assertEqual([tag for tag, text in headings if not text], [])
        self.assertGreater(self.value("count('input, select')"), 10)
        self.assertEqual(self.value("all('input, select').filter(({ labels }) => !labels.length).length"), 0)


class Sample(Page):
    name = "sample"

    def test_looks(self):
        self.check_looks()

    def test_the_first_screen_shows_the_most_influential_parameter(self):
        stiffness, values = self.report["axes"][1]["numbers"], self.report["quantities"][0]["values"]
        points = self.points("main")
        self.assertEqual(len(points), 200)
        for run, point in points.items():
            self.assertEqual(point["x"], stiffness[run])
            self.assertEqual(None if point.get("rim") else point["y"], values[run])

    def test_no_point_lies_outside_its_plot(self):
        self.do("drawAll();")
        for figure in ("main", "scatter"):
            outside = self.do("""const { x, y } = figures[arguments[0]].chart.scales;
                const within = (scale, place) => place >= scale.min && place <= scale.max;
                return points(arguments[0]).filter((point) => !within(x, point.x) || !within(y, point.y));""", figure)
            self.assertEqual(outside, [], figure)

    def test_histogram_quantiles_and_shares(self):
        self.do("drawAll();")
        distribution = self.report["distributions"][0]
        values = [value for value in self.report["quantities"][0]["values"] if value is not None]
        bins = self.value("points('histogram')")
        self.assertEqual(sum(one["y"] for one in bins), distribution["count"])
        self.assertEqual((bins[0]["low"], bins[-1]["high"]), (min(values), max(values)))
        for one in bins[:-1]:
            self.assertEqual(one["y"], sum(one["low"] <= value < one["high"] for value in values))
        row = self.value("cells('#distribution .scroll tbody tr')")[0]
        self.assertEqual(int(row[0]), distribution["count"])
        self.assertEqual(len(row), 3 + len(distribution["quantiles"]))
        for text, (_, value) in zip(row[3:], distribution["quantiles"]):
            self.assertAlmostEqual(float(text), value, places=3)
        self.assertEqual(self.value("text('.share-bars')"), "EI86 %T12 %")

    def test_a_number_filters_by_its_bounds(self):
        self.do("enter(all('#controls .bounds input')[1], '5', 'change');")
        tension = self.report["axes"][0]["numbers"]
        self.assertEqual(self.listed(), [run for run in range(200) if tension[run] <= 5])

    def test_sensitivities_and_what_cannot_be_told_apart(self):
        self.do("drawAll();")
        self.assertIn("T and EI cannot be told apart", self.value("text('#sensitivities')"))
        self.assertIn("0.0021 mm/(N mm²)", self.value("text('#sensitivities')"))

    def test_a_section_without_data_does_not_appear(self):
        sections = self.value("sections.map(({ id }) => id)")
        self.assertEqual(sections, ["distribution", "sensitivities", "failures", "runs"])


class Grid(Page):
    name = "grid"

    def test_looks(self):
        self.check_looks()

    def test_lines_that_differ_in_numbers_alone_are_one_entry_in_shades_of_one_colour(self):
        names = "figures.main.legend.querySelectorAll('.entry .name')"
        entries = self.value(f"[...{names}].map(({{ textContent }}) => textContent)")
        self.assertEqual(entries, ["planar, EI = 65 … 6132 N mm²", "helical, EI = 65 … 6132 N mm²"])
        self.assertIn("Shades: EI", self.value("figures.main.note.textContent"))
        colours = dict(self.value("datasets('main').map(({ line, borderColor }) => [line, borderColor])"))
        self.assertEqual(len(colours), 10)
        self.assertEqual(len(set(colours.values())), 10)
        self.assertEqual((colours[4], colours[9]), ("#0072b2", "#d55e00"))

    def test_the_legend_hides_and_shows_a_family(self):
        entry = "figures.main.legend.querySelector('.entry')"
        self.do(f"{entry}.click();")
        self.assertEqual({point["line"] for point in self.points("main").values()}, set(range(5, 10)))
        self.do(f"{entry}.click();")
        self.assertEqual({point["line"] for point in self.points("main").values()}, set(range(10)))

    def test_lines_go_over_their_axis_in_the_order_of_its_numbers(self):
        lines = "datasets('main').filter(({ showLine }) => showLine)"
        drawn = self.value(lines + ".map(({ data }) => data.map(({ x }) => x))")
        self.assertEqual(drawn, [[1, 2, 5, 10, 15, 20]] * 8)

    def test_sensitivities_are_one_table_of_a_few_places_or_all(self):
        self.do("drawAll();")
        rows = self.value("cells('.places tr')")
        self.assertEqual(rows[0], ["at", "T", "EI"])
        self.assertEqual(len(rows), 1 + 12)
        places = [place["at"].replace("mm^2", "mm²") for place in self.report["sensitivities"]]
        self.assertEqual((rows[1][0], rows[12][0]), (places[0], places[-1]))
        self.assertEqual(rows[1][1:], ["−0.5−0.25 mm/N", "0.10.001 mm/(N mm²)"])
        self.assertIn("12 of 48 places", self.value("figures.sensitivities.note.textContent"))
        self.do("figures.sensitivities.box.querySelector('button').click(); drawAll();")
        self.assertEqual([row[0] for row in self.value("cells('.places tbody tr')")], places)
        self.do("figures.sensitivities.box.querySelector('button').click(); drawAll();")
        self.assertEqual(self.value("count('.places tbody tr')"), 12)

    def test_energies_of_many_runs_are_some_spread_over_all(self):
        self.do("drawAll();")
        shown = self.value("datasets('energies')[0].data.map(({ run }) => run)")
        self.assertEqual(len(set(shown)), 40)
        self.assertEqual(len({run // 6 for run in shown}), 10)
        self.assertIn("40 of 60 runs, evenly spread", self.value("figures.energies.note.textContent"))
        self.assertIn("did not converge", self.value("figures.energies.note.textContent"))

    def test_reasons_that_differ_in_numbers_alone_are_one(self):
        self.do("drawAll();")
        groups = self.value("cells('.failures-table tbody tr')")
        self.assertEqual([group[:2] for group in groups], [["12", "stalled"]])
        self.assertIn("stopped after 100 iterations; stationarity 0.5e-03 N (numbers of run 4)", groups[0][2])

    def test_findings_are_in_the_words_of_the_page(self):
        self.assertEqual(self.value("text('.headline .text')"), "1 % more of T lowers peak displacement by 0.5 %")
        self.assertIn("65 N mm² among", self.value("text('.headline .detail')"))


class Parameters(Page):
    name = "parameters"

    def test_looks(self):
        self.check_looks()

    def test_the_first_screen_shows_what_each_parameter_does(self):
        self.assertEqual(self.value("points('main').map(({ x, y }) => [y, x])"),
                         [["T", 0.4551234], ["R", -0.25], ["anchoring", -0.2]])

    def test_runs_are_named_by_what_the_baseline_has_not(self):
        self.do("drawAll();")
        names = self.do("""const { ticks } = figures.energies.chart.scales.y;
            return ticks.map(({ label }) => [label].flat().join(" "));""")
        self.assertEqual(names[:2] + names[-1:], ["baseline", "T 9.8 N", "R 6.12 mm"])
        self.assertNotIn("heat-map", self.value("sections.map(({ id }) => id)"))

    def test_one_place_is_a_table_below_what_cannot_be_told_apart(self):
        self.do("drawAll();")
        rows = self.value("cells('#sensitivities .scroll tbody tr')")
        self.assertEqual([row[:3] for row in rows], [["T", "0.46 mm/N", "0.455"], ["R", "−0.43 mm/mm", "−0.25"],
                                                     ["anchoring", "−312 mm/(N/mm²)", "−0.2"]])
        above = "find('.warning-box').compareDocumentPosition(figures.sensitivities.root)"
        self.assertEqual(self.value(above), 4)  # the figure follows
        self.assertEqual(self.value("count('.warning-box p')"), 1)


class Ablation(Page):
    name = "ablation"

    def test_looks(self):
        self.check_looks()

    def test_the_first_screen_shows_effects(self):
        means = [effect["mean"] for effect in self.report["effects"]]
        self.assertEqual(self.value("points('main').map(({ x }) => x)"), means)

    def test_names_are_text(self):
        self.do("drawAll();")
        self.assertEqual(self.value("text('h1')"), self.report["study"]["title"])
        self.assertIn(fabricate_reports.HOSTILE, self.value("text('.headline .text')"))
        self.assertEqual(self.value("text('#controls .filter b')"), fabricate_reports.HOSTILE)
        self.assertIn("<i>none</i>", self.value("text('#runs')"))
        self.assertEqual(self.value("count('td i, th i, h1 b')"), 0)
        self.assertEqual(self.value("report"), self.report)

    def test_a_long_detail_shows_its_beginning(self):
        self.assertTrue(self.value("find('.clamped').scrollHeight > find('.clamped').clientHeight"))
        self.do("find('.headline button').click();")
        self.assertEqual(self.value("count('.clamped')"), 0)


class Failures(Page):
    name = "failures"

    def test_looks(self):
        self.check_looks()

    def test_how_the_runs_ended_is_what_is_shown(self):
        self.assertEqual(self.value("sections.map(({ id }) => id)"), ["heat-map", "failures", "runs"])
        shown = self.value("figures.main.root.textContent")
        self.assertIn("3 diverged", shown)
        self.assertIn("3 refused: nlopt: found 2 equalities", shown)
        self.assertEqual(self.listed(), list(range(6)))


class Bare(Page):
    """Runs of which nothing is known but how they ended."""

    name = "bare"

    @classmethod
    def fabricated(cls):
        return fabricate_reports.failures() | {"quantities": [], "lines": [], "along": None, "headlines": []}

    def test_it_opens(self):
        self.assertIn("3 diverged", self.value("figures.main.root.textContent"))
        self.assertEqual(self.listed(), list(range(6)))


class Large(Page):
    name = "large"

    def test_looks(self):
        self.check_looks()

    def test_opening(self):
        times = []
        for _ in range(3):
            self.open(1280, "light")
            times.append(self.value("bowstringReport.readyAfter"))
        rest = self.do("const before = performance.now(); drawAll(); return performance.now() - before;")
        print(f"\n10 000 runs ({self.file.stat().st_size / 1e6:.1f} MB): ready after "
              f"{', '.join(f'{time:.0f}' for time in times)} ms; all sections at once: {rest:.0f} ms more")
        self.assertEqual(len(self.listed()), 10000)

    def test_what_is_below_the_fold_waits(self):
        self.assertIsNone(self.value("figures.energies.chart"))

    def test_only_rows_in_sight_are_elements(self):
        self.do("drawAll();")
        rows = "all('#runs tbody tr[aria-rowindex]').map((row) => Number(row.cells[0].textContent))"
        first = self.value(rows)
        self.do("find('.rows').scrollTop = find('.rows').scrollHeight; find('.rows').dispatchEvent(new Event('scroll'));")
        last = self.value(rows)
        self.assertIn(0, first)
        self.assertIn(9999, last)
        self.assertLess(max(len(first), len(last)), 100)

    def test_a_crowd_is_thinned_and_that_is_said(self):
        points = self.points("main")
        self.assertGreater(len(points), 1000)
        self.assertLessEqual(len(points), 4200)
        self.assertIn("of 500 formulations", self.value("figures.main.note.textContent"))
        self.assertIn(self.report["headlines"][0]["lines"][0], {point["line"] for point in points.values()})

    def test_a_long_legend_is_cut(self):
        entries = "figures.main.legend.querySelectorAll('.entry').length"
        self.assertEqual(self.value(entries), 24)
        self.do("figures.main.legend.querySelector('.link').click();")
        self.assertEqual(self.value(entries), 25)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("write_report_page")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    options, others = parser.parse_known_args()
    missing = browsers.missing()
    if missing:
        print(f"there is no {' and no '.join(missing)}; install the packages chromium and chromium-driver")
        return 1 if os.environ.get("BOWSTRING_TEST_BROWSER") == "1" else SKIPPED
    Page.write_report_page, Page.out = options.write_report_page, options.out
    options.out.mkdir(parents=True, exist_ok=True)
    with browsers.Browser() as Page.browser:
        result = unittest.main(argv=[sys.argv[0], *others], exit=False).result
    # Subtests that failed are one case.
    bad = len({getattr(case, "test_case", case).id() for case, _ in result.failures + result.errors})
    print(f"{result.testsRun - bad} passed, {bad} failed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
