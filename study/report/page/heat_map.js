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
  const chosen = { across: bySize[0], down: bySize[1], shows: "value" };
  const names = mappableAxes.map((axis) => [axis, axes[axis].name]);
  const pickAxis = (which, other) => (picked) => {
    const axis = Number(picked);
    if (axis === chosen[other]) chosen[other] = chosen[which];
    chosen[which] = axis;
    redraw();
  };
  const pickShown = (name) => {
    chosen.shows = name;
    redraw();
  };

  const draw = () => {
    const shown = mappedNames();
    if (!shown.includes(chosen.shows)) chosen.shows = shown[0] === "value" ? "value" : "status";
    const shownNames = shown.map((name) => [name, name]);
    figure.tools.replaceChildren(
      picker("Across", names, chosen.across, pickAxis("across", "down")),
      picker("Down", names, chosen.down, pickAxis("down", "across")),
      picker("Show", shownNames, chosen.shows, pickShown),
    );
    drawHeatMap(figure, chosen);
  };
  selectionMarks.push(draw);
  return draw;
}

/** What is known of the quantity, and what is known of every run. */
function mappedNames() {
  const { quantity } = view;
  return [hasValues(quantity) ? "value" : "", hasErrors(quantity) ? "error" : "", "time", "status"].filter(Boolean);
}

/** Per row and column its {runs, failed, known, value}, the median of what is known; null without a run. */
function heatCells(across, down, of) {
  const cells = axes[down].labels.map(() => axes[across].labels.map(() => null));
  for (const run of view.runs) {
    const row = runs.choice[down][run];
    const column = runs.choice[across][run];
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

function drawHeatMap(figure, { across, down, shows }) {
  const { name, of } = mapped[shows];
  figure.showTitle(`${capital(name())}: ${axes[down].name} against ${axes[across].name}`);
  // What did not converge has a place, not a say in the median.
  const cells = heatCells(across, down, (run) => (converged(run) || shows === "status" ? of(run) : null));
  const scale = heatScale(
    cells
      .flat()
      .filter(Boolean)
      .map(({ value }) => value)
      .filter(isKnown),
    shows,
  );
  figure.showElements(tableFrame(heatTable(cells, across, down, scale, shows), figure.heading.textContent));
  figure.legend.replaceChildren(...(shows === "status" ? [] : [scaleLegend(scale)]), ...failureKeys(cells));
  const most = Math.max(
    ...cells
      .flat()
      .filter(Boolean)
      .map((cell) => cell.runs.length),
    0,
  );
  figure.showNote(
    most > 1 && shows !== "status" ? "Each cell: the median of its converged runs over all other axes." : "",
  );
  const columns = [axes[down].column, axes[across].column, name(), "runs", "not converged"];
  const rowOf = (cell, row, column) => [
    alternativeValue(down, row),
    alternativeValue(across, column),
    cell.value,
    cell.runs.length,
    cell.failed,
  ];
  figure.showData(columns, () =>
    cells.flatMap((row, r) => row.flatMap((cell, c) => (cell ? [rowOf(cell, r, c)] : []))),
  );
}

/** What the marks mean that stand in these cells. */
function failureKeys(cells) {
  const own = cells.flat().filter((cell) => cell?.failed);
  const key = (mark, text) =>
    element("span", { class: "entry-text" }, element("i", { class: "failed-key" }, mark), text);
  return [
    own.some(({ runs: all, failed }) => failed < all.length)
      ? key(element("i", { class: "corner" }), "some runs did not converge")
      : null,
    own.some(({ runs: all, failed }) => failed === all.length) ? key("✕", "no run converged") : null,
  ].filter(Boolean);
}

const alternativeValue = (axis, alternative) =>
  isNumeric(axis) ? axes[axis].numbers[alternative] : axes[axis].labels[alternative];

/** Logarithmic where positive values differ by orders of magnitude. */
function heatScale(values, shows) {
  const [low, high] = shows === "status" ? [0, 1] : extent(values);
  const isLog = low > 0 && high / low > 50;
  const share = (value) =>
    high === low ? 0.5 : isLog ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  return { low, high, isLog, share };
}

function scaleLegend({ low, high, isLog }) {
  if (low > high) return "";
  const stops = range(10)
    .map((index) => css(scaleColour(index / 9)))
    .join(", ");
  return element(
    "span",
    { class: "scale" },
    numberText(low, 3),
    element("i", { style: `background: linear-gradient(to right, ${stops})` }),
    numberText(high, 3),
    isLog ? " (logarithmic)" : "",
  );
}

function heatTable(cells, across, down, scale, shows) {
  const isDense = axes[across].labels.length > 14;
  const step = Math.ceil(axes[across].labels.length / 7); // labels that find room
  const head = axes[across].labels.map((label, index) =>
    element(
      "th",
      { scope: "col", title: label },
      isDense ? (index % step ? "" : shortened(unitText(label), 14)) : shortened(unitText(label), 22),
    ),
  );
  const rows = cells.map((row, index) =>
    element(
      "tr",
      {},
      element(
        "th",
        { scope: "row", title: axes[down].labels[index] },
        shortened(unitText(axes[down].labels[index]), 26),
      ),
      row.map((cell, column) =>
        heatCell(cell, scale, shows, isDense, `${axes[down].labels[index]}, ${axes[across].labels[column]}`),
      ),
    ),
  );
  return element(
    "table",
    { class: isDense ? "heat dense" : "heat", style: isDense ? `width: min(100%, ${170 + 34 * head.length}px)` : null },
    element("caption", { class: "axis-title" }, `${axisTitle(across)} →`),
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        element(
          "th",
          { class: "axis-title", scope: "col", style: isDense ? "width: 150px" : null },
          `${axisTitle(down)} ↓`,
        ),
        head,
      ),
    ),
    element("tbody", {}, rows),
  );
}

function heatCell(cell, scale, shows, isDense, place) {
  if (!cell) return element("td", { class: "empty", title: `${place}: no run` });
  const { runs: own, failed, value } = cell;
  const colour = cellColour(cell, scale, shows);
  const failures = failed ? `, ${failed} of ${own.length} not converged (${statusWords(own)})` : "";
  const classes = [
    failed === own.length ? "all-failed" : failed ? "some-failed" : "",
    own.includes(view.selected) ? "marked" : "",
  ];
  const properties = {
    title: `${place}: ${numberText(value)}${failures}`,
    class: classes.join(" ").trim() || null,
    style: colour ? `background-color: ${css(colour)}; color: ${inkOn(colour)}` : null,
    onclick: () => select(own[0]),
  };
  return element("td", properties, cellWords(cell, shows, isDense));
}

function cellColour({ runs: own, value }, scale, shows) {
  if (value === null) return null;
  if (shows !== "status") return scaleColour(scale.share(value));
  const status = commonStatus(own);
  return status
    ? channels(statusColour(status))
    : between(channels(statusColours.failed), channels(statusColours.converged), value);
}

function cellWords({ runs: own, failed, value }, shows, isDense) {
  if (isDense) return failed === own.length ? "✕" : "";
  if (shows === "status") return commonStatus(own) ?? `${own.length - failed} of ${own.length}`;
  return failed === own.length ? "✕" : numberText(value, 4);
}

/** What all of these runs ended with; null where they differ. */
function commonStatus(list) {
  const [first] = list;
  return list.every((run) => runs.status[run] === runs.status[first]) ? runs.status[first] : null;
}
