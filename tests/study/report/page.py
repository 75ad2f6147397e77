"""A page of a fabricated report in a browser, as the cases of test_page.py look at it."""

import csv
import io
import json
import pathlib
import subprocess
import unittest

import fabricate_reports

WIDTHS, SCHEMES = (1280, 420), ("light", "dark")

# What every script of a case finds.
HELPERS = """
const { figures, view, sections, report, listedRuns, drawAll } = bowstringReport;
const find = (selector) => document.querySelector(selector);
const all = (selector) => [...document.querySelectorAll(selector)];
const text = (selector) => find(selector).textContent;
const count = (selector) => all(selector).length;
const cells = (selector) => all(selector).map((row) => [...row.cells].map((cell) => cell.textContent));
const datasets = (figure) => figures[figure].chart.data.datasets;
const points = (figure) => datasets(figure).flatMap(({ data, line }) => data.map((point) => ({ ...point, line })));
const enter = (field, value, event) => { field.value = value; field.dispatchEvent(new Event(event)); };
const opened = async (figure) => {
  const data = figures[figure].root.querySelector(".data");
  const filled = data.open ? null : new Promise((done) => data.addEventListener("toggle", done, { once: true }));
  data.open = true;
  await filled;
  return data;
};
"""


class Page(unittest.TestCase):
    """The page of one report. Every case opens it anew, and after each nothing may have failed or been fetched."""

    browser, write_report_page, out = None, None, None  # set by main()
    name = None  # of the report

    @classmethod
    def setUpClass(cls):
        if not cls.name:
            raise unittest.SkipTest("has no report of its own")
        cls.report = cls.fabricated()
        cls.file = pathlib.Path(cls.out) / f"{cls.name}.html"
        data = cls.file.with_suffix(".json")
        data.write_text(json.dumps(cls.report), encoding="utf-8")
        subprocess.run([cls.write_report_page, data, cls.file], check=True)

    @classmethod
    def fabricated(cls):
        return fabricate_reports.REPORTS[cls.name]()

    def setUp(self):
        self.open(1280, "light")

    def open(self, width, scheme):
        self.browser.resize(width, 800)
        self.browser.prefer(scheme)
        self.browser.log("browser")
        self.browser.requests()
        self.browser.open(self.file.resolve().as_uri())
        self.browser.wait_for("document.documentElement.dataset.ready === 'true'")

    def tearDown(self):
        self.do("drawAll();")
        self.assertEqual(self.browser.log("browser"), [])
        self.assertEqual(self.value("document.documentElement.dataset.errors"), "0")
        address, requests = self.file.resolve().as_uri(), self.browser.requests()
        self.assertIn(address, requests)
        self.assertEqual({request for request in requests if not request.startswith(("data:", "blob:"))}, {address})

    def do(self, script, *arguments):
        return self.browser.run(HELPERS + script, *arguments)

    def value(self, expression, *arguments):
        return self.do(f"return {expression};", *arguments)

    def points(self, figure):
        """What a chart of runs holds: {run: point}."""
        points = self.value("points(arguments[0])", figure)
        self.assertEqual(len({point["run"] for point in points}), len(points))
        return {point["run"]: point for point in points}

    def listed(self):
        """The runs of the table, in its order."""
        self.do("drawAll();")
        return self.value("listedRuns()")

    def shown_data(self, figure):
        """The data of a figure as its reader sees them."""
        return self.do("""return (async () => {
            const data = await opened(arguments[0]);
            return [...data.querySelectorAll("tr")].map((row) => [...row.cells].map((cell) => cell.textContent));
        })();""".replace("arguments[0]", json.dumps(figure)))

    def saved_data(self, figure):
        """The rows of the file that its button saves."""
        text = self.do("""return (async () => {
            const data = await opened(%s);
            const addressOf = URL.createObjectURL;
            let saved = null;
            URL.createObjectURL = (blob) => { saved = blob; return addressOf.call(URL, blob); };
            data.querySelector(".download").click();
            URL.createObjectURL = addressOf;
            return saved.text();
        })();""" % json.dumps(figure))
        return list(csv.DictReader(io.StringIO(text, newline="")))

    def check_looks(self):
        """Nothing overflows sideways, at any width and in any scheme; leaves screenshots."""
        grounds = set()
        for width in WIDTHS:
            for scheme in SCHEMES:
                with self.subTest(width=width, scheme=scheme):
                    self.open(width, scheme)
                    picture = self.file.with_suffix("")
                    self.browser.screenshot(f"{picture}-{width}-{scheme}-first.png")
                    self.do("drawAll();")
                    self.assertEqual(self.value("document.documentElement.scrollWidth"), width)
                    grounds.add((scheme, self.value("getComputedStyle(document.body).backgroundColor")))
                    self.browser.screenshot(f"{picture}-{width}-{scheme}.png", whole=True)
        self.assertEqual(len(grounds), len(SCHEMES))
        self.assertEqual(len({ground for _, ground in grounds}), len(SCHEMES))
