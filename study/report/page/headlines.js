// The first screen: what came of the study in words, and the one diagram that shows it.

const headlineNames = {
  recommendation: "Recommendation",
  convergence: "Convergence",
  effect: "Effect",
  warning: "Warning",
  failures: "Failures",
};
const mostHeadlines = 4;

function drawHeader() {
  document.title = `${study.title || study.name}: study report`;
  document.getElementById("title").textContent = study.title || study.name;
  document.getElementById("subtitle").textContent = [
    study.file,
    `Bowstring ${study.version}`,
    study.repeats > 1 ? `times are medians of ${study.repeats}` : "",
  ]
    .filter(Boolean)
    .join(" · ");
  drawRunCounts();
}

/** How many runs ended how, as one bar and in words. */
function drawRunCounts() {
  const counts = [...countBy(range(runCount), (run) => runs.status[run])];
  const part = ([status, count]) => element("span", { style: `flex: ${count}; background: ${statusColour(status)}` });
  const word = ([status, count]) =>
    element(
      "span",
      { class: "count" },
      element("i", { class: "dot", style: `background: ${statusColour(status)}`, "aria-hidden": "true" }),
      `${wholeText(count)} ${status}`,
    );
  document
    .getElementById("run-counts")
    .replaceChildren(
      element("p", {}, element("strong", {}, counted(runCount, "run")), ...counts.map(word)),
      element("div", { class: "shares", "aria-hidden": "true" }, counts.map(part)),
    );
}

function drawHeadlines() {
  const { headlines } = report;
  const holder = document.getElementById("headlines");
  const kept = new Set([headlines[0], headlines.find(({ kind }) => kind === "convergence")]);
  for (const headline of headlines) if (kept.size < mostHeadlines) kept.add(headline);
  const ordered = headlines.filter((headline) => kept.has(headline));
  const others = headlines.filter((headline) => !kept.has(headline));
  holder.append(...ordered.map(headlineCard));
  if (others.length) {
    holder.append(
      element(
        "details",
        { class: "more" },
        element("summary", {}, counted(others.length, "further finding")),
        ...others.map(headlineCard),
      ),
    );
  }
}

function headlineCard(headline, index) {
  const card = element(
    "article",
    { class: `headline ${headline.kind}${index === 0 ? " first" : ""}` },
    element("p", { class: "kind" }, headlineNames[headline.kind] ?? headline.kind),
    element("p", { class: headline.text.length > 110 ? "text long" : "text" }, asOnPage(headline.text)),
  );
  if (headline.detail) card.append(clamped(asOnPage(headline.detail)));
  return card;
}

/** A finding with quantities and units as the page writes them: "peak displacement", "mm²". */
function asOnPage(text) {
  const byLength = range(quantities.length).sort((a, b) => quantities[b].column.length - quantities[a].column.length);
  const named = byLength.reduce((out, one) => out.replaceAll(quantities[one].column, quantityName(one)), text);
  return unitText(named);
}

/** A text that shows its first lines, and the rest when asked. */
function clamped(text) {
  const paragraph = element("p", { class: "detail clamped" }, text);
  if (text.length < 240) paragraph.classList.remove("clamped");
  else paragraph.append(" ");
  const more = button(
    "more",
    () => {
      more.textContent = paragraph.classList.toggle("clamped") ? "more" : "less";
    },
    { class: "link" },
  );
  return text.length < 240 ? paragraph : element("div", {}, paragraph, more);
}

/** The diagram of the first screen: cost against error, or what comes nearest to it by what is known. */
function mainDiagram() {
  if (hasErrors(view.quantity)) return drawPrecision;
  if (report.along !== null && hasValues(view.quantity)) return (figure) => drawAgainst(figure, report.along);
  if (sensitivitiesAtOnePlace()) return drawElasticities;
  const numeric = influentialAxes()[0] ?? report.line_over ?? axes.findIndex((_, axis) => isNumeric(axis));
  if (numeric >= 0 && hasValues(view.quantity)) return (figure) => drawAgainst(figure, numeric);
  if (report.effects.length)
    return (figure) => {
      figure.legend.replaceChildren();
      drawEffects(figure);
    };
  return hasValues(view.quantity) ? (figure) => drawAgainst(figure, null) : drawOutcomes;
}

let cost = "solve time";

function buildMainFigure() {
  const figure = addFigure(document.getElementById("main-figure"), "main", { height: 400, level: 2 });
  if (!quantities.length) return () => drawOutcomes(figure);
  return () => {
    figure.tools.replaceChildren();
    figure.legend.replaceChildren();
    mainDiagram()(figure);
  };
}

function drawPrecision(figure) {
  const { quantity } = view;
  figure.showTitle(`Cost against error of ${quantityName(quantity)}`);
  figure.tools.replaceChildren(
    picker(
      "Cost",
      Object.keys(costs).map((name) => [name, name]),
      cost,
      (name) => {
        cost = name;
        redraw();
      },
    ),
  );
  const { title, of } = costs[cost];
  const series = drawPoints(figure, {
    xOf: of,
    yOf: (run) => errorOf(quantity, run),
    log: { x: true, y: true },
    connected: report.along !== null,
    scales: (points) => ({
      x: logScale(
        title,
        points.map(({ x }) => x),
      ),
      y: logScale(
        errorTitle(quantity),
        points.map(({ y }) => y),
      ),
    }),
    tip: (run) => [alongText(run), ...runTip(run)],
    plugins: isKnown(study.target_error)
      ? [levelLine(study.target_error, `target ${percentText(study.target_error)}`)]
      : [],
  });
  const { reference_text: reference } = quantities[quantity];
  figure.note.append(` Lower left is better. Reference: ${reference}.`);
  drawLegend(figure.legend);
  figure.showData(
    ...pointData(series, [
      [title, of],
      ["error", (run) => errorOf(quantity, run)],
    ]),
  );
}

/** Values against an axis, or run by run without one. */
function drawAgainst(figure, axis) {
  const { quantity } = view;
  const name = axis === null ? "the runs" : axes[axis].name;
  figure.showTitle(`${capital(quantityName(quantity))} against ${name}`);
  const xOf = axis === null ? (run) => run : (run) => placeOf(axis, run);
  const valueOfRun = (run) => quantities[quantity].values[run];
  const series = drawPoints(figure, {
    xOf,
    yOf: valueOfRun,
    log: {},
    connected: axis !== null && (axis === report.along || axis === report.line_over),
    byX: true,
    scales: (points) => ({
      x:
        axis === null
          ? linearScale("Run")
          : axisScale(
              axis,
              points.map(({ x }) => x),
            ),
      y: linearScale(capital(quantityTitle(quantity))),
    }),
    tip: (run) => [describeRun(run), ...runTip(run)].flatMap((row) => wrapped(row, 60)),
  });
  drawLegend(figure.legend);
  figure.showData(...pointData(series, [[quantities[quantity].column, valueOfRun]]));
}

const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** Where no run has a value: how the runs ended is what there is to see. */
function drawOutcomes(figure) {
  figure.showTitle("No run has a value: how they ended");
  figure.showElements(outcomeBars());
  const groups = outcomes(view.runs);
  figure.showData(["status", "reason", "runs"], () =>
    groups.map(({ status, reason, list }) => [status, reason, list.length]),
  );
}
