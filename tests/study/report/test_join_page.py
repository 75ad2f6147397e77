"""How the page's parts are joined: python3 test_join_page.py JOIN_PAGE.py. Prints 'N passed, N failed'."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

JOIN_PAGE = sys.argv[1]
PAGE = "<style>{{style}}</style><script>{{chart}}</script><i>{{report}}</i><script>{{script}}</script>"


class JoinPage(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def join(self, page=PAGE, style="a {}", chart="chart();", scripts=("one();", "two();")):
        names = ["out.cpp", "page.html", "page.css", "chart.js", *(f"{index}.js" for index in range(len(scripts)))]
        for name, text in zip(names[1:], (page, style, chart, *scripts)):
            (self.folder / name).write_text(text, encoding="utf-8")
        return subprocess.run([sys.executable, JOIN_PAGE, *names], cwd=self.folder, stderr=subprocess.PIPE, text=True)

    def test_head_and_tail(self):
        self.assertEqual(self.join().returncode, 0)
        out = (self.folder / "out.cpp").read_text(encoding="utf-8")
        self.assertIn("(<style>a {}</style><script>chart();</script><i>)", out)
        self.assertIn("(</i><script>one();\n\ntwo();</script>)", out)

    def check_refusal(self, message, **parts):
        done = self.join(**parts)
        self.assertEqual((done.returncode, done.stderr), (1, message + "\n"))
        self.assertFalse((self.folder / "out.cpp").exists())

    def test_what_could_end_its_element(self):
        message = "holds </script or <!--; expected nothing that can end its element; write it in parts"
        self.check_refusal("1.js: " + message, scripts=("one();", "'</SCRIPT>'"))
        self.check_refusal("chart.js: " + message, chart="// <!--")

    def test_a_page_without_a_place_for_the_report(self):
        self.check_refusal("page.html: holds {{report}} 0 times; expected it once, where the report's JSON goes", page="")

    def test_what_could_end_a_literal(self):
        self.check_refusal('a part of the page holds )bowstring-page"; expected nothing that ends a C++ literal; '
                           "write it in parts", style=')bowstring-page"')


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], exit=False)
    bad = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - bad} passed, {bad} failed")
    sys.exit(1 if bad else 0)
