#!/usr/bin/env python3
"""Draws the figures of docs/transport.md.

    docs/make_transport_figures.py switches WALK_PLANS docs/transport-switches.svg
    docs/make_transport_figures.py error BOWSTRING [docs/transport-error.svg]

`switches`: a transport value and its derivative through switches of the optimal plan, which the program WALK_PLANS of
the build (tests/transport/walk-plans) computes. `error`: time against error of `sinkhorn` beside `exact`, measured here and printed.
"""
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

WIDTH, HEIGHT = 900, 548
LEFT, TOP, PANEL_WIDTH, PANEL_HEIGHT, GAP_X, GAP_Y = 70, 56, 350, 175, 100, 62


class Panel:
    """One pair of axes; data to pixels."""

    def __init__(self, column, row, x_range, y_values):
        self.left = LEFT + column * (PANEL_WIDTH + GAP_X)
        self.top = TOP + row * (PANEL_HEIGHT + GAP_Y)
        self.x0, self.x1 = x_range
        low, high = min(y_values), max(y_values)
        margin = 0.08 * (high - low)
        self.y0, self.y1 = low - margin, high + margin

    def x(self, value):
        return self.left + PANEL_WIDTH * (value - self.x0) / (self.x1 - self.x0)

    def y(self, value):
        return self.top + PANEL_HEIGHT * (self.y1 - value) / (self.y1 - self.y0)


def text(x, y, words, anchor="middle", size=13, color="#333"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{color}">{words}</text>'


def ticks(low, high):
    """About five round numbers in a range."""
    rough = (high - low) / 5
    power = 10 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= rough)
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def frame(panel, title, x_label, y_label, x_ticks):
    out = [
        f'<rect x="{panel.left}" y="{panel.top}" width="{PANEL_WIDTH}" height="{PANEL_HEIGHT}" fill="none" stroke="#999"/>'
    ]
    for value in ticks(panel.y0, panel.y1):
        y = panel.y(value)
        out.append(f'<path d="M{panel.left} {y:.1f}h{PANEL_WIDTH}" stroke="#e4e4e4"/>')
        out.append(text(panel.left - 7, y + 4, f"{value:g}", "end", 11))
    for value, words in x_ticks:
        out.append(text(panel.x(value), panel.top + PANEL_HEIGHT + 16, words, size=11))
    if title:
        out.append(text(panel.left + PANEL_WIDTH / 2, panel.top - 12, title, size=14, color="#111"))
    if x_label:
        out.append(text(panel.left + PANEL_WIDTH / 2, panel.top + PANEL_HEIGHT + 34, x_label, size=12))
    middle = panel.top + PANEL_HEIGHT / 2
    out.append(
        f'<text transform="translate({panel.left - 46} {middle:.0f}) rotate(-90)" text-anchor="middle" font-size="12" '
        f'fill="#333">{y_label}</text>'
    )
    return out


def line(points, color, width=1.6):
    path = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}"/>'


def draw_walk(column, walk, title, x_ticks):
    x_range = (walk[0]["parameter"], walk[-1]["parameter"])
    value = Panel(column, 0, x_range, [p["value"] for p in walk])
    slope = Panel(column, 1, x_range, [p[key] for p in walk for key in ("before", "after")])
    out = frame(value, title, "", "W₂²", x_ticks) + frame(slope, "", "angle θ", "dW₂²/dθ", x_ticks)
    out.append(line([(value.x(p["parameter"]), value.y(p["value"])) for p in walk], "#1f5fa8"))
    pieces, piece = [], []
    for p in walk:
        if p["switch"]:
            piece.append((slope.x(p["parameter"]), slope.y(p["before"])))
            pieces.append(piece)
            piece = [(slope.x(p["parameter"]), slope.y(p["after"]))]
            x = slope.x(p["parameter"])
            out.append(
                f'<path class="subgradients" d="M{x:.2f} {slope.y(p["before"]):.2f}V{slope.y(p["after"]):.2f}" '
                f'stroke="#d9822b" stroke-width="3" stroke-opacity="0.75"/>'
            )
            out.append(f'<circle cx="{value.x(p["parameter"]):.2f}" cy="{value.y(p["value"]):.2f}" r="2.6" fill="#d9822b"/>')
        else:
            piece.append((slope.x(p["parameter"]), slope.y(p["reported"])))
    pieces.append(piece)
    out += [line(piece, "#1f5fa8") for piece in pieces if len(piece) > 1]
    out += [
        f'<circle class="reported" cx="{slope.x(p["parameter"]):.2f}" cy="{slope.y(p["reported"]):.2f}" r="2.6" fill="#111"/>'
        for p in walk
        if p["switch"]
    ]
    return out


def switch_figure(walks):
    quarter = math.pi / 4
    square_ticks = [(k * quarter, words) for k, words in enumerate(["0", "π/4", "π/2", "3π/4", "π"])]
    knot_ticks = [(k * math.pi / 6, words) for k, words in enumerate(["0", "π/6", "π/3", "π/2", "2π/3"])]
    switches = sum(p["switch"] for p in walks["knot"])
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        'font-family="sans-serif">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    parts += draw_walk(0, walks["square"], "A square turned on itself", square_ticks)
    parts += draw_walk(1, walks["knot"], f"A closed curve of 24 points: {switches} switches", knot_ticks)
    parts.append(
        text(WIDTH / 2, HEIGHT - 8, "orange: the subgradients at a switch of the plan; black: the element that is reported", size=12)
    )
    return "\n".join(parts + ["</svg>", ""])


def write_curve(file, count, shape):
    rows = [",".join(repr(x) for x in shape(k / (count - 1))) for k in range(count)]
    file.write_text("x_mm,y_mm,z_mm\n" + "\n".join(rows) + "\n")


def planned_path(t):
    return 150 * t, 25 * math.sin(2 * math.pi * t), 10 * math.sin(math.pi * t)


def observed_path(t):
    return 150 * t + 2 * math.sin(5 * t), 18 * math.sin(2 * math.pi * t + 0.2) + 1, 14 * math.sin(math.pi * t)


def timed(bowstring, files, *options, repeats=5):
    """The document of one comparison, and the median of the seconds that several took."""
    call = [bowstring, "transport", *files, "--json", *options]
    documents = [json.loads(subprocess.run(call, check=True, capture_output=True, text=True).stdout) for _ in range(repeats)]
    return documents[0], statistics.median(d["seconds"]["cost"] + d["seconds"]["solve"] for d in documents)


def measure_errors(bowstring, count=200):
    """exact: (value, seconds); sinkhorn: [(epsilon, relative error of <C, P>, seconds, iterations)]."""
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder) / name for name in ("a.csv", "b.csv")]
        write_curve(files[0], count, planned_path)
        write_curve(files[1], count, observed_path)
        exact, seconds = timed(bowstring, files)
        rows = []
        for epsilon in (300, 100, 30, 10, 3, 1, 0.3, 0.1, 0.03):
            options = ["--method", "sinkhorn", "--set", f"epsilon={epsilon}", "--set", "debiased=false"]
            found, taken = timed(bowstring, files, *options, repeats=3)
            error = found["transport_cost"] / exact["value"] - 1
            rows.append((epsilon, error, taken, found["iterations"]))
    return (exact["value"], seconds), rows


def print_errors(exact, rows):
    print(f"exact: {exact[0]:.6f} mm^2 in {1e3 * exact[1]:.2f} ms")
    print("epsilon_mm2,relative_error,milliseconds,iterations,times_exact")
    for epsilon, error, seconds, iterations in rows:
        print(f"{epsilon:g},{error:.3e},{1e3 * seconds:.2f},{iterations},{seconds / exact[1]:.1f}")


def error_figure(exact, rows):
    """Logarithms of both axes; what is exact to rounding stands at the lower edge."""
    points = [(math.log10(1e3 * seconds), math.log10(error), f"{epsilon:g}") for epsilon, error, seconds, _ in rows]
    exact_x = math.log10(1e3 * exact[1])
    xs = [x for x, _, _ in points] + [exact_x]
    panel = Panel(0, 0, (math.floor(min(xs)), math.ceil(max(xs))), [y for _, y, _ in points])
    decades = range(math.floor(panel.x0), math.ceil(panel.x1) + 1)
    out = frame(panel, "", "time, ms", "log10 of the relative error", [(k, f"{10.0**k:g}") for k in decades])
    out.append(line([(panel.x(x), panel.y(y)) for x, y, _ in points], "#1f5fa8"))
    for x, y, words in points:
        out.append(f'<circle cx="{panel.x(x):.2f}" cy="{panel.y(y):.2f}" r="3" fill="#1f5fa8"/>')
        out.append(text(panel.x(x) + 7, panel.y(y) - 5, words, "start", 11))
    x = panel.x(exact_x)
    out.append(f'<path d="M{x:.2f} {panel.top}V{panel.top + PANEL_HEIGHT}" stroke="#d9822b" stroke-width="2"/>')
    out.append(text(x, panel.top - 8, "exact", color="#b0611a"))
    width, height = PANEL_WIDTH + LEFT + 30, TOP + PANEL_HEIGHT + 50
    return "\n".join(
        [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" font-family="sans-serif">',
         f'<rect width="{width}" height="{height}" fill="white"/>',
         text(LEFT + PANEL_WIDTH / 2, 20, "sinkhorn, by ε in mm²: two curves of 200 points", size=14, color="#111")]
        + out + ["</svg>", ""])


def write(file, content):
    with open(file + ".new", "w", encoding="utf-8") as out:
        out.write(content)
    os.replace(file + ".new", file)


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "switches":
        walks = json.loads(subprocess.run([sys.argv[2]], check=True, capture_output=True, text=True).stdout)
        write(sys.argv[3], switch_figure(walks))
    elif len(sys.argv) in (3, 4) and sys.argv[1] == "error":
        measured = measure_errors(sys.argv[2])
        print_errors(*measured)
        if len(sys.argv) == 4:
            write(sys.argv[3], error_figure(*measured))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
