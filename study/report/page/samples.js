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
  const numbers = [own.mean, own.deviation, ...own.quantiles.map(([, value]) => value)];
  const quantileColumns = own.quantiles.map(([share]) => percentText(share));
  const tables = [
    element("h3", {}, `${capital(quantityTitle(view.quantity))} over the whole sample`),
    tableFrame(
      table(
        ["runs", "mean", "standard deviation", ...quantileColumns],
        [[own.count, ...numbers.map((value) => roundedTo(5, value))]],
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
  if (report.inseparable.length) root.append(inseparableBox());
  const figure = report.sensitivities.length ? addFigure(root, "sensitivities", { canvas: false }) : null;
  return () => {
    if (figure) drawSensitivities(figure);
  };
}

/** The parameters whose effects the quantities cannot tell apart, a line for each pair. */
function inseparableBox() {
  return element(
    "div",
    { class: "warning-box" },
    report.inseparable.map(({ axes: pair, cosine, text }) =>
      element(
        "p",
        { title: text },
        element("b", {}, `${axes[pair[0]].name} and ${axes[pair[1]].name} cannot be told apart`),
        ` by these quantities: ${cosine > 0 ? "they act alike" : "they act against each other in one proportion"} `,
        `(cosine of their sensitivities ${numberText(cosine)}).`,
      ),
    ),
  );
}

const ownSensitivities = () => report.sensitivities.filter(({ quantity }) => quantity === view.quantity);

/** Whether a study of parameters about one place has something to say of the quantity: then that is its result. */
const sensitivitiesAtOnePlace = () =>
  !sampledAxes.length && ownSensitivities().length === 1 && ownSensitivities()[0].entries.length > 1;

const byElasticity = (entries) =>
  [...entries].sort((a, b) => Math.abs(b.elasticity ?? 0) - Math.abs(a.elasticity ?? 0));

/** At one place: what each parameter does, as bars. */
function drawElasticities(figure) {
  const { at, entries } = ownSensitivities()[0];
  const shown = byElasticity(entries).slice(0, mostBars);
  const name = quantityName(view.quantity);
  figure.showTitle(`What 1 % more of each parameter does to ${name}`);
  const options = baseOptions();
  Object.assign(options, { indexAxis: "y", interaction: { mode: "y", intersect: false } });
  options.scales = {
    x: linearScale(`Change of ${name} (%)`),
    y: scaleOf("", { type: "category", title: { display: false }, ticks: { autoSkip: false } }),
  };
  options.plugins.tooltip.callbacks = {
    label: ({ dataIndex }) => {
      const { elasticity } = shown[dataIndex];
      return [`elasticity: ${signedText(elasticity)}`, `derivative: ${derivativeText(shown[dataIndex])}`];
    },
  };
  const names = shown.map(({ axis }) => axes[axis].name);
  figure.showChart(
    {
      type: "bar",
      data: {
        labels: names,
        datasets: [
          {
            label: name,
            data: shown.map(({ elasticity }, index) => ({ x: elasticity, y: names[index] })),
            backgroundColor: shown.map(({ elasticity }) => pageColour(elasticity < 0 ? "negative" : "positive")),
            maxBarThickness: 26,
          },
        ],
      },
      options,
    },
    shown.length * 38 + 80,
  );
  figure.showNote(`At ${unitText(at)}.`);
  figure.showData(["axis", "derivative", "elasticity"], () =>
    shown.map(({ axis, derivative, elasticity }) => [axes[axis].name, derivative, elasticity]),
  );
}

const derivativeText = ({ axis, derivative }) =>
  `${numberText(derivative)} ${derivativeUnit(quantities[view.quantity].unit, axes[axis].unit)}`.trim();

const mostPlaces = 12;
let showsAllPlaces = false;

/** Of a grid: a row per place, a column per parameter, the most influential first. */
function placesTable(places) {
  const sizes = groupBy(
    places.flatMap(({ entries }) => entries),
    ({ axis }) => axis,
  ).map(([axis, entries]) => ({ axis, size: median(entries.map(({ elasticity }) => Math.abs(elasticity ?? 0))) }));
  const parameters = sizes.sort((a, b) => b.size - a.size).map(({ axis }) => axis);
  const cell = (entry) =>
    entry
      ? element(
          "span",
          { class: "sensitivity" },
          numberText(entry.elasticity, 3),
          element("small", { class: "muted" }, derivativeText(entry)),
        )
      : unknownText;
  const rows = places.map(({ at, entries }) => [
    unitText(at),
    ...parameters.map((axis) => cell(entries.find((entry) => entry.axis === axis))),
  ]);
  return table(["at", ...parameters.map((axis) => axes[axis].name)], rows, { class: "places" });
}

function drawSensitivities(figure) {
  const own = ownSensitivities();
  const { column } = quantities[view.quantity];
  figure.showTitle(`What ${quantityName(view.quantity)} is sensitive to`);
  if (!own.length) figure.showElements(element("p", { class: "muted" }, "Nothing is known of this quantity."));
  else if (own.length === 1)
    figure.showElements(
      element("h4", {}, unitText(own[0].at)),
      tableFrame(sensitivityTable(own[0].entries), "Sensitivities"),
    );
  else {
    const shown = showsAllPlaces ? own : spreadOver(own, mostPlaces);
    const flip = () => {
      showsAllPlaces = !showsAllPlaces;
      redraw();
    };
    const more = showsAllPlaces ? `Show ${mostPlaces}` : `Show all ${wholeText(own.length)} places`;
    figure.showElements(tableFrame(placesTable(shown), "Sensitivities"));
    const properties = { class: "link", "aria-expanded": String(showsAllPlaces) };
    if (own.length > mostPlaces) figure.box.append(button(more, flip, properties));
  }
  figure.showNote(
    !showsAllPlaces && own.length > mostPlaces ? `${mostPlaces} of ${own.length} places, evenly spread.` : "",
    own.length > 1 ? "Large: elasticity, small: derivative." : "",
    "Elasticity: the relative change of the quantity over that of the parameter;",
    "−0.5 means that 1 % more of the parameter takes 0.5 % away.",
  );
  figure.showData(["at", "axis", `derivative of ${column}`, "elasticity"], () =>
    own.flatMap(({ at, entries }) =>
      entries.map((entry) => [at, axes[entry.axis].name, entry.derivative, entry.elasticity]),
    ),
  );
}

function sensitivityTable(entries) {
  const sorted = byElasticity(entries);
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
    sorted.map((entry) => [
      axes[entry.axis].name,
      element("span", { class: "number" }, derivativeText(entry)),
      roundedTo(3, entry.elasticity),
      bar(entry.elasticity),
    ]),
  );
}

function derivativeUnit(unit, parameterUnit) {
  const [above, below] = [unitText(unit) || "1", unitText(parameterUnit)];
  if (!below) return unitText(unit);
  return `${above}/${/[ ·*/]/.test(below) ? `(${below})` : below}`;
}
