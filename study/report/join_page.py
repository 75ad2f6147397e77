"""Joins the parts of the report page to the C++ file that holds it:

    python3 join_page.py OUT.cpp PAGE.html STYLE.css CHART.js SCRIPT.js…

PAGE.html says by {{style}}, {{chart}}, {{script}} and {{report}} where each goes. The scripts share one module, in the
order they are given."""

import pathlib
import re
import sys

DELIMITER = "bowstring-page"


def read(name):
    return pathlib.Path(name).read_text(encoding="utf-8")


def element(name, kind):
    """The text of a file that is to stand inside <script> or <style>."""
    text = read(name).strip()
    if re.search(rf"</{kind}|<!--", text, re.IGNORECASE):
        sys.exit(f"{name}: holds </{kind} or <!--; expected nothing that can end its element; write it in parts")
    return text


def literal(text):
    if f'){DELIMITER}"' in text:
        sys.exit(f"a part of the page holds ){DELIMITER}\"; expected nothing that ends a C++ literal; write it in parts")
    return f'R"{DELIMITER}({text}){DELIMITER}"'


def join(page, style, chart, scripts):
    parts = {
        "style": element(style, "style"),
        "chart": element(chart, "script"),
        "script": "\n\n".join(element(script, "script") for script in scripts),
    }
    halves = read(page).split("{{report}}")
    if len(halves) != 2:
        sys.exit(f"{page}: holds {{{{report}}}} {len(halves) - 1} times; expected it once, where the report's JSON goes")
    return [re.sub(r"\{\{(style|chart|script)\}\}", lambda match: parts[match[1]], half) for half in halves]


def main(out, page, style, chart, *scripts):
    head, tail = join(page, style, chart, scripts)
    pathlib.Path(out).write_text(
        '#include "study/report/page_parts.hpp"\n\n'
        "namespace bowstring::study {\n\n"
        f"const std::string_view page_head =\n{literal(head)};\n\n"
        f"const std::string_view page_tail =\n{literal(tail)};\n\n"
        "}  // namespace bowstring::study\n", encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
