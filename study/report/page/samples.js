// What a sample of several numbers says: the distribution of a quantity, and what it is sensitive to.

const sampledAxes = range(axes.length).filter((axis) => axes[axis].spacing === "sampled");

const distributionOf = (quantity) => report.distributions.find((one) => one.quantity === quantity);

/** The sampled axes, the one with the largest share in the variance of the quantity first. */
function influentialAxes() {
  const shares = distributionOf(view.quantity)?.shares;
  const shareOf = (axis) => shares?.[sampledAxes.indexOf(axis)] ?? 0;
  return [...sampledAxes].sort((a, b) => shareOf(b) - shareOf(a));
}

function buildDistribution(root) {
  const histogram = addFigure(root, "histogram", { height: 300 });
  const words = element("div", {});
  root.append(words);
  // The first screen has the most influential one.
  let against = influentialAxes()[1] ?? sampledAxes[0] ?? axes.findIndex((_, axis) => isNumeric(axis));
  const scatter = against >= 0 ? addFigure(root, "scatter", { height: 360 }) : null;
  const names = axes.map(({ name }, axis) => [axis, name]);
  return () => {
    drawHistogram(histogram);
    words.replaceChildren(...distributionTables());
    if (!scatter) return;
    drawAgainst(scatter, against);
    scatter.tools.replaceChildren(
      picker("Against", names, against, (axis) => {
        against = Number(axis);
        redraw();
      }),
    );
  };
}

function drawHistogram(figure) {
  const { quantity } = view;
  const values = view.runs
    .filter(converged)
    .map((run) => quantities[quantity].values[run])
    .filter(isKnown)
    .sort((a, b) => a - b);
  const bins = binsOf(values);
  figure.showTitle(`Distribution of ${quantityName(quantity)}`);
  const options = baseOptions();
  options.scales = {
    x: linearScale(capital(quantityTitle(quantity)), { grace: 0, offset: false, ticks: { includeBounds: false } }),
    y: linearScale("Runs", { beginAtZero: true, ticks: { precision: 0 } }),
  };
  options.plugins.tooltip.callbacks = {
    title: ([item]) => (item ? `${numberText(item.raw.low)} to ${numberText(item.raw.high)}` : ""),
    label: (item) => counted(item.raw.y, "run"),
  };
  if (values.length) [options.scales.x.min, options.scales.x.max] = [bins[0].low, bins.at(-1).high];
  figure.showChart({
    type: "bar",
    data: {
      datasets: [
        {
          label: "runs",
          data: bins.map(({ low, high, count }) => ({ x: (low + high) / 2, y: count, low, high })),
          backgroundColor: pageColour("positive"),
          barPercentage: 1,
          categoryPercentage: 0.96,
        },
      ],
    },
    options,
    plugins: values.length ? [quantileLines(values)] : [],
  });
  figure.showNote(
    `${counted(values.length, "converged run")}${isFiltered() ? " of those that the filters leave" : ""};`,
    "dashed: the 5, 50 and 95 % quantiles.",
  );
  figure.showData(["from", "to", "runs"], () => bins.map(({ low, high, count }) => [low, high, count]));
}

/** Bins of Freedman and Diaconis's width, between 5 and 60 of them. */
function binsOf(sorted) {
  if (!sorted.length) return [];
  const [low, high] = [sorted[0], sorted.at(-1)];
  if (low === high) return [{ low: low - 0.5, high: high + 0.5, count: sorted.length }];
  const width = (2 * (quantile(sorted, 0.75) - quantile(sorted, 0.25))) / Math.cbrt(sorted.length);
  const count = Math.min(Math.max(width > 0 ? Math.ceil((high - low) / width) : 5, 5), 60);
  const edge = (index) => (index === count ? high : low + ((high - low) * index) / count);
  const bins = range(count).map((index) => ({ low: edge(index), high: edge(index + 1), count: 0 }));
  let bin = 0;
  for (const value of sorted) {
    while (bin < count - 1 && value >= bins[bin].high) ++bin;
    ++bins[bin].count;
  }
  return bins;
}

const quantileLines = (sorted) => ({
  id: "quantileLines",
  afterDatasetsDraw({ ctx, chartArea, scales }) {
    ctx.save();
    ctx.strokeStyle = pageColour("ink");
    ctx.setLineDash([4, 3]);
    for (const share of [0.05, 0.5, 0.95]) {
      const x = scales.x.getPixelForValue(quantile(sorted, share));
      ctx.beginPath();
      ctx.moveTo(x, chartArea.top);
      ctx.lineTo(x, chartArea.bottom);
      ctx.stroke();
    }
    ctx.restore();
  },
});

function distributionTables() {
  const own = distributionOf(view.quantity);
  if (!own) return [];
  const quantileColumns = own.quantiles.map(([share]) => percentText(share));
  const tables = [
    element("h3", {}, `${capital(quantityTitle(view.quantity))} over the whole sample`),
    tableFrame(
      table(
        ["runs", "mean", "standard deviation", ...quantileColumns],
        [[own.count, own.mean, own.deviation, ...own.quantiles.map(([, value]) => value)]],
      ),
      "Quantiles",
    ),
  ];
  if (!own.shares) return tables;
  const shares = own.shares
    .map((share, index) => [axes[sampledAxes[index]]?.name ?? "", share])
    .sort((a, b) => (b[1] ?? -1) - (a[1] ?? -1));
  return [...tables, element("h3", {}, "Shares of the parameters in its variance"), shareBars(shares)];
}

/** [[name, share or null]] as bars in words' height. */
function shareBars(shares) {
  return element(
    "div",
    { class: "share-bars" },
    shares.flatMap(([name, share]) => [
      element("span", {}, name),
      element(
        "span",
        { class: "track", "aria-hidden": "true" },
        element("i", { style: `width: ${100 * Math.min(Math.max(share ?? 0, 0), 1)}%` }),
      ),
      element("span", { class: "number" }, isKnown(share) ? percentText(share) : unknownText),
    ]),
  );
}

function buildSensitivities(root) {
  const figure = report.sensitivities.length ? addFigure(root, "sensitivities", { canvas: false }) : null;
  const warnings = report.inseparable.map(({ axes: pair, cosine, text }) =>
    element(
      "div",
      { class: "warning-box" },
      element(
        "p",
        {},
        element("b", {}, `${axes[pair[0]].name} and ${axes[pair[1]].name} cannot be told apart. `),
        text,
      ),
      element("p", { class: "muted" }, `Cosine of their sensitivities: ${numberText(cosine)}`),
    ),
  );
  root.append(...warnings);
  return () => {
    if (figure) drawSensitivities(figure);
  };
}

function drawSensitivities(figure) {
  const own = report.sensitivities.filter(({ quantity }) => quantity === view.quantity);
  const { unit, column } = quantities[view.quantity];
  figure.showTitle(`What ${quantityName(view.quantity)} is sensitive to`);
  if (!own.length) figure.showElements(element("p", { class: "muted" }, "Nothing is known of this quantity."));
  else
    figure.showElements(
      ...own.flatMap(({ at, entries }) => [
        element("h4", {}, at),
        tableFrame(sensitivityTable(entries, unit), "Sensitivities"),
      ]),
    );
  figure.showNote(
    "Elasticity: the relative change of the quantity over that of the parameter;",
    "−0.5 means that 1 % more of the parameter takes 0.5 % away.",
  );
  figure.showData(["at", "axis", `derivative of ${column}`, "elasticity"], () =>
    own.flatMap(({ at, entries }) =>
      entries.map((entry) => [at, axes[entry.axis].name, entry.derivative, entry.elasticity]),
    ),
  );
}

function sensitivityTable(entries, unit) {
  const sorted = [...entries].sort((a, b) => Math.abs(b.elasticity ?? 0) - Math.abs(a.elasticity ?? 0));
  const most = Math.max(...sorted.map(({ elasticity }) => Math.abs(elasticity ?? 0)), 1e-300);
  const bar = (elasticity) =>
    element(
      "span",
      { class: "signed-track", "aria-hidden": "true" },
      element("i", {
        class: elasticity < 0 ? "negative" : "positive",
        style: `width: ${(50 * Math.abs(elasticity ?? 0)) / most}%`,
      }),
    );
  return table(
    ["parameter", "derivative", "elasticity", ""],
    sorted.map(({ axis, derivative, elasticity }) => [
      axes[axis].name,
      element("span", { class: "number" }, `${numberText(derivative)} ${derivativeUnit(unit, axes[axis].unit)}`),
      elasticity ?? null,
      bar(elasticity),
    ]),
  );
}

function derivativeUnit(unit, parameterUnit) {
  const [above, below] = [unitText(unit) || "1", unitText(parameterUnit)];
  if (!below) return unitText(unit);
  return `${above}/${/[ ·*/]/.test(below) ? `(${below})` : below}`;
}
