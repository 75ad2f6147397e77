// What all charts share: scales that can be read, tooltips, marks.

const { Chart } = window;
delete window.Chart;
Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
Chart.defaults.font.family = "system-ui, sans-serif";
Chart.defaults.font.size = 12;

function baseOptions() {
  return {
    interaction: { mode: "nearest", intersect: true },
    plugins: { legend: { display: false }, tooltip: tooltipStyle() },
    onClick: (event, hits, chart) => {
      const point = hits.length ? chart.data.datasets[hits[0].datasetIndex].data[hits[0].index] : null;
      if (isKnown(point?.run)) select(point.run);
    },
  };
}

function tooltipStyle() {
  return {
    backgroundColor: pageColour("tip"),
    titleColor: pageColour("tip-ink"),
    bodyColor: pageColour("tip-ink"),
    displayColors: false,
    padding: 10,
  };
}

/** A scale in the page's colours; `more` overrides. */
function scaleOf(title, more = {}) {
  return {
    title: { display: true, text: title, color: pageColour("ink") },
    grid: { color: pageColour("grid"), borderColor: pageColour("muted") },
    ...more,
    ticks: { color: pageColour("ink"), ...more.ticks },
  };
}

/** [low, high] around positive values, with some air. */
function logRange(values) {
  const [low, high] = extent(values.filter((value) => value > 0));
  if (low > high) return [0.1, 1];
  const air = Math.max(0.06 * Math.log10(high / low), 0.1);
  return [low / 10 ** air, high * 10 ** air];
}

/** Decades where there are enough of them to read a scale from, otherwise 1, 2, 5 of each, otherwise every digit. */
function logTicks(low, high) {
  const decades = Math.log10(high / low);
  const digits = decades >= 2.5 ? [1] : decades >= 0.8 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9];
  const step = Math.max(1, Math.ceil(decades / 8));
  const ticks = [];
  for (let exponent = Math.floor(Math.log10(low)); exponent <= Math.ceil(Math.log10(high)); ++exponent) {
    if (digits.length === 1 && exponent % step) continue;
    for (const digit of digits) ticks.push(Number(`${digit}e${exponent}`));
  }
  return ticks.filter((tick) => tick >= low && tick <= high);
}

/** Ticks of one scale are all written in the same way: as decimals where none gets long, or else as powers of ten. */
function logTickWords(ticks) {
  const [low, high] = extent(ticks);
  return low >= 1e-3 && high < 1e5 ? (value) => numberText(value, 3) : powerTickText;
}

function powerTickText(value) {
  const whole = Math.floor(Math.log10(value) + 1e-9);
  const digits = value / 10 ** whole;
  return digits < 1.001 ? powerText(whole) : `${numberText(digits, 2)}·${powerText(whole)}`;
}

/** A logarithmic scale over `values`, or at the `ticks` given. */
function logScale(title, values, ticks = null) {
  const [min, max] = logRange(values);
  const places = ticks ?? logTicks(min, max);
  return scaleOf(title, {
    type: "logarithmic",
    min,
    max,
    afterBuildTicks: (scale) => {
      scale.ticks = places.map((value) => ({ value }));
    },
    ticks: { callback: logTickWords(places), maxRotation: 0 },
  });
}

function linearScale(title, more = {}) {
  return scaleOf(title, {
    type: "linear",
    grace: "4%",
    ...more,
    ticks: { callback: (value) => numberText(value, 6), maxTicksLimit: 8, ...more.ticks },
  });
}

/** A linear scale that ends where its numbers do, as an axis has no reason to show 0. */
function closeScale(title, numbers) {
  const [low, high] = extent(numbers);
  const air = 0.04 * (high - low || Math.abs(high) || 1);
  const [min, max] = [low - air, high + air];
  const ticks = roundNumbers(min, max);
  return linearScale(title, {
    min,
    max,
    grace: 0,
    afterBuildTicks: (scale) => {
      scale.ticks = ticks.map((value) => ({ value }));
    },
    ticks: { maxRotation: 0 },
  });
}

/** Four to ten of them between two numbers. */
function roundNumbers(low, high) {
  const decade = 10 ** Math.floor(Math.log10((high - low) / 4));
  const step = decade * [5, 2, 1].find((factor) => 4 * factor * decade <= high - low);
  const count = (place) => Math.round(place * 1e6) / 1e6;
  return range(Math.floor(count(high / step)) - Math.ceil(count(low / step)) + 1).map((index) =>
    Number(((Math.ceil(count(low / step)) + index) * step).toPrecision(12)),
  );
}

/** Whether positive numbers lie more evenly on a logarithmic scale: by where their median is. */
function isSpreadByFactors(numbers) {
  const [low, high] = extent(numbers);
  if (!(low > 0) || high / low < 4) return false;
  const middle = median(numbers);
  return Math.abs(Math.log(middle / low) / Math.log(high / low) - 0.5) < Math.abs((middle - low) / (high - low) - 0.5);
}

/** The scale of an axis of the study: its numbers, or its alternatives side by side. */
function axisScale(axis, places, isLogarithmic = isSpreadByFactors(places.filter(isKnown))) {
  if (!isNumeric(axis)) {
    const count = axes[axis].labels.length;
    return linearScale(axisTitle(axis), {
      min: -0.5,
      max: count - 0.5,
      grace: 0,
      afterBuildTicks: (scale) => {
        scale.ticks = range(count).map((value) => ({ value }));
      },
      ticks: { callback: (value) => shortened(unitText(axes[axis].labels[value] ?? ""), 18), maxTicksLimit: 40 },
    });
  }
  const known = places.filter(isKnown);
  if (!isLogarithmic && known.length) return closeScale(axisTitle(axis), known);
  const numbers = [...new Set(known)].sort((a, b) => a - b);
  return logScale(axisTitle(axis), known, numbers.length <= 12 ? numbers : null);
}

/** A ring around the run that the reader selected. */
const selectionRing = {
  id: "selectionRing",
  afterDatasetsDraw(chart) {
    if (view.selected === null) return;
    chart.data.datasets.forEach((dataset, index) => {
      const at = dataset.data.findIndex((point) => point?.run === view.selected);
      const place = at >= 0 && chart.isDatasetVisible(index) ? chart.getDatasetMeta(index).data[at] : null;
      if (place) ring(chart.ctx, place.x, place.y);
    });
  },
};

function ring(context, x, y) {
  context.save();
  context.strokeStyle = pageColour("ink");
  context.lineWidth = 2.5;
  context.beginPath();
  context.arc(x, y, 10, 0, 2 * Math.PI);
  context.stroke();
  context.restore();
}

/** A dashed line at the height of a value, with its name. */
const levelLine = (value, name) => ({
  id: "levelLine",
  beforeDatasetsDraw({ ctx, chartArea, scales }) {
    const y = scales.y.getPixelForValue(value);
    if (!(y > chartArea.top && y < chartArea.bottom)) return;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = pageColour("muted");
    ctx.setLineDash([5, 5]);
    ctx.beginPath();
    ctx.moveTo(chartArea.left, y);
    ctx.lineTo(chartArea.right, y);
    ctx.stroke();
    ctx.font = "11px system-ui, sans-serif";
    ctx.textAlign = "right";
    ctx.fillText(name, chartArea.right - 4, y - 5);
    ctx.restore();
  },
});

/** What is said of a run when a pointer is over its point. */
function runTip(run, ...more) {
  const { quantity } = view;
  return [
    `${quantityName(quantity)}: ${withNumberUnit(quantities[quantity].values[run], quantities[quantity].unit)}`,
    quantities[quantity].errors ? `error: ${errorText(errorOf(quantity, run))}` : null,
    `solve time: ${withNumberUnit(runs.solve_seconds[run], "s")}`,
    converged(run) ? null : `${runs.status[run]}: ${shortened(runs.reason[run] || "without a reason", 70)}`,
    ...more,
  ].filter(Boolean);
}

const withNumberUnit = (value, unit) =>
  isKnown(value) && unit ? `${numberText(value)} ${unitText(unit)}` : numberText(value);
