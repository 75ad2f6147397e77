// Two axes against each other: each cell holds the median of its runs, and how many of them failed.

const mostAlternatives = 100;

const mapped = {
  value: { name: () => quantityTitle(view.quantity), of: (run) => quantities[view.quantity].values[run] },
  error: { name: () => `error of ${quantityName(view.quantity)}`, of: (run) => errorOf(view.quantity, run) },
  time: { name: () => "solve time (s)", of: (run) => runs.solve_seconds[run] },
  status: { name: () => "share converged", of: (run) => (converged(run) ? 1 : 0) },
};

const mappableAxes = range(axes.length).filter((axis) => {
  const { labels, spacing } = axes[axis];
  return spacing !== "sampled" && labels.length > 1 && labels.length <= mostAlternatives;
});

function buildHeatMap(root) {
  const figure = addFigure(root, "heat-map", { canvas: false });
  // The longer axis goes sideways.
  const bySize = [...mappableAxes].sort((a, b) => axes[b].labels.length - axes[a].labels.length);
  let [across, down] = bySize, shows = "value";
  const names = mappableAxes.map((axis) => [axis, axes[axis].name]);
  const pick = (set) => (chosen) => { set(chosen); redraw(); };

  const draw = () => {
    const shown = [...(hasValues(view.quantity) ? ["value"] : []), ...(hasErrors(view.quantity) ? ["error"] : []), "time", "status"];
    if (!shown.includes(shows)) shows = shown[0] === "value" ? "value" : "status";
    figure.tools.replaceChildren(
      picker("Across", names, across, pick((axis) => { [across, down] = [Number(axis), Number(axis) === down ? across : down]; })),
      picker("Down", names, down, pick((axis) => { [down, across] = [Number(axis), Number(axis) === across ? down : across]; })),
      picker("Show", shown.map((name) => [name, name]), shows, pick((name) => { shows = name; })));
    drawHeatMap(figure, across, down, shows);
  };
  selectionMarks.push(draw);
  return draw;
}

/** Per row and column {known, failed, count, value}; null without a run. */
function heatCells(across, down, of) {
  const cells = axes[down].labels.map(() => axes[across].labels.map(() => null));
  for (const run of view.runs) {
    const row = runs.choice[down][run], column = runs.choice[across][run];
    if (row < 0 || column < 0) continue;
    const cell = (cells[row][column] ??= { known: [], failed: 0, runs: [] });
    const value = of(run);
    cell.runs.push(run);
    if (isKnown(value)) cell.known.push(value);
    if (!converged(run)) ++cell.failed;
  }
  for (const cell of cells.flat()) if (cell) cell.value = median(cell.known);
  return cells;
}

function drawHeatMap(figure, across, down, shows) {
  const { name, of } = mapped[shows];
  figure.showTitle(`${capital(shows === "status" ? "share converged" : name())}: ${axes[down].name} against ${axes[across].name}`);
  // What did not converge has a place, not a say in the median.
  const cells = heatCells(across, down, shows === "status" ? (run) => Number(converged(run)) : (run) => (converged(run) ? of(run) : null));
  const scale = heatScale(cells.flat().filter(Boolean).map(({ value }) => value).filter(isKnown), shows);
  figure.box.replaceChildren(tableFrame(heatTable(cells, across, down, scale, shows), figure.heading.textContent));
  figure.legend.replaceChildren(...(shows === "status" ? [] : [scaleLegend(scale)]), ...failureKeys(cells));
  const most = Math.max(...cells.flat().filter(Boolean).map((cell) => cell.runs.length), 0);
  figure.showNote(most > 1 && shows !== "status" ? "Each cell: the median of its converged runs over all other axes." : "");
  figure.showData([axes[down].column, axes[across].column, name(), "runs", "not converged"], () => cells.flatMap((row, r) => row.flatMap((cell, c) => (cell
    ? [[alternativeValue(down, r), alternativeValue(across, c), cell.value, cell.runs.length, cell.failed]] : []))));
}

/** What the marks mean that stand in these cells. */
function failureKeys(cells) {
  const own = cells.flat().filter((cell) => cell?.failed);
  const key = (mark, text) => element("span", { class: "entry-text" }, element("i", { class: "failed-key" }, mark), text);
  return [
    own.some(({ runs: all, failed }) => failed < all.length) ? key(element("i", { class: "corner" }), "some runs did not converge") : null,
    own.some(({ runs: all, failed }) => failed === all.length) ? key("✕", "no run converged") : null,
  ].filter(Boolean);
}

const alternativeValue = (axis, alternative) => (isNumeric(axis) ? axes[axis].numbers[alternative] : axes[axis].labels[alternative]);

/** Logarithmic where positive values differ by orders of magnitude. */
function heatScale(values, shows) {
  const [low, high] = shows === "status" ? [0, 1] : extent(values);
  const isLog = low > 0 && high / low > 50;
  const share = (value) => (high === low ? 0.5 : isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));
  return { low, high, isLog, share };
}

function scaleLegend({ low, high, isLog }) {
  if (low > high) return "";
  const stops = range(10).map((index) => css(scaleColour(index / 9))).join(", ");
  return element("span", { class: "scale" }, numberText(low, 3),
    element("i", { style: `background: linear-gradient(to right, ${stops})` }), numberText(high, 3), isLog ? " (logarithmic)" : "");
}

function heatTable(cells, across, down, scale, shows) {
  const isDense = axes[across].labels.length > 14;
  const head = axes[across].labels.map((label) => element("th", { scope: "col", title: label }, isDense ? "" : shortened(label, 22)));
  const ends = element("th", { scope: "col", colspan: head.length, class: "ends" }, element("span", {}, axes[across].labels[0]), element("span", {}, axes[across].labels.at(-1)));
  const rows = cells.map((row, index) => element("tr", {},
    element("th", { scope: "row", title: axes[down].labels[index] }, shortened(axes[down].labels[index], 26)),
    row.map((cell, column) => heatCell(cell, scale, shows, isDense, `${axes[down].labels[index]}, ${axes[across].labels[column]}`))));
  return element("table", { class: isDense ? "heat dense" : "heat", style: isDense ? `width: min(100%, ${170 + 34 * head.length}px)` : null },
    element("caption", { class: "axis-title" }, `${axisTitle(across)} →`),
    element("thead", {}, element("tr", {}, element("th", { class: "axis-title", scope: "col", style: isDense ? "width: 150px" : null }, `${axisTitle(down)} ↓`), isDense ? ends : head)), element("tbody", {}, rows));
}

function heatCell(cell, scale, shows, isDense, place) {
  if (!cell) return element("td", { class: "empty", title: `${place}: no run` });
  const { runs: own, failed, value } = cell;
  const words = `${place}: ${numberText(value)}${failed ? `, ${failed} of ${own.length} not converged (${statusWords(own)})` : ""}`;
  const classes = [failed === own.length ? "all-failed" : failed ? "some-failed" : "", own.includes(view.selected) ? "marked" : ""];
  const colour = value === null ? null : shows === "status" ? statusScale(value) : scaleColour(scale.share(value));
  const text = failed === own.length ? element("span", { class: "failed" }, "✕") : isDense ? "" : cellWords(cell, shows);
  return element("td", {
    title: words, class: classes.join(" ").trim() || null, onclick: () => select(own[0]),
    style: colour ? `background-color: ${css(colour)}; color: ${inkOn(colour)}` : null,
  }, text);
}

const cellWords = ({ runs: own, failed, value }, shows) => (shows === "status" ? `${own.length - failed}/${own.length}` : numberText(value, 4));

/** From vermillion, nothing converged, to bluish green, all did. */
const statusScale = (share) => [213, 94, 0].map((part, index) => Math.round(part + share * ([0, 158, 115][index] - part)));
