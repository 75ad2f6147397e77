// The report as it was written (study/report/README.md), and what is asked of it.

const report = JSON.parse(document.getElementById("report").textContent);
const { study, axes, quantities, runs, lines } = report;
const runCount = runs.status.length;

const isKnown = (value) => typeof value === "number" && Number.isFinite(value);
const converged = (run) => runs.status[run] === "converged";
const range = (count) => Array.from({ length: count }, (_, index) => index);

// Per run the formulation it belongs to; -1 where it belongs to none.
const lineOfRun = new Int32Array(runCount).fill(-1);
lines.forEach((line, index) =>
  line.runs.forEach((run) => {
    lineOfRun[run] = index;
  }),
);

const isNumeric = (axis) => Array.isArray(axes[axis].numbers) && axes[axis].numbers.length > 0;

/** What the run has on an axis, in words. */
function alternativeOf(axis, run) {
  const alternative = runs.choice[axis][run];
  return alternative < 0 ? "–" : axes[axis].labels[alternative];
}

/** Where the run stands on an axis: its number, or else the place of its alternative in the list; null without. */
function placeOf(axis, run) {
  const alternative = runs.choice[axis][run];
  if (alternative < 0) return null;
  return isNumeric(axis) ? axes[axis].numbers[alternative] : alternative;
}

const unitText = (unit) => unit.replace(/\^(-?\d+)/g, (_, power) => raised(power));
const withUnit = (name, unit) => (unit ? `${name} (${unitText(unit)})` : name);
const axisTitle = (axis) => withUnit(axes[axis].name, isNumeric(axis) ? axes[axis].unit : "");

/** "peak displacement (mm)": a column's name carries its unit, which a reader would rather see once. */
function quantityName(quantity) {
  const { column, unit } = quantities[quantity];
  const suffix = `_${unit.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_+|_+$/g, "")}`;
  const name = unit && column.toLowerCase().endsWith(suffix.toLowerCase()) ? column.slice(0, -suffix.length) : column;
  return name.replaceAll("_", " ");
}
const quantityTitle = (quantity) => withUnit(quantityName(quantity), quantities[quantity].unit);

/** "Relative error of …"; where a reference is 0 the error is not relative. */
function errorTitle(quantity) {
  const isRelative = !quantities[quantity].references?.some((reference) => reference === 0);
  return `${isRelative ? "Relative error" : "Error"} of ${quantityName(quantity)}`;
}

/** The error of a run without its sign; null where it is not known. */
function errorOf(quantity, run) {
  const error = quantities[quantity]?.errors?.[run];
  return isKnown(error) ? Math.abs(error) : null;
}
const hasErrors = (quantity) => range(runCount).some((run) => errorOf(quantity, run) !== null);
const hasValues = (quantity) => quantities[quantity]?.values.some(isKnown) ?? false;

/** A run in words by the axes given, all of them by default. */
function describeRun(run, chosen = range(axes.length)) {
  const parts = chosen
    .filter((axis) => runs.choice[axis][run] >= 0)
    .map((axis) => `${axes[axis].name} ${alternativeOf(axis, run)}`);
  return parts.join(", ");
}

/** The alternatives that most runs have, where every run differs from them in one axis at most; null where not so. */
const baseline = findBaseline();

function findBaseline() {
  if (axes.length < 2) return null;
  const usual = runs.choice.map((list) => groupBy(list, (alternative) => alternative)[0]?.[0]);
  const differences = (run) => axes.filter((_, axis) => runs.choice[axis][run] !== usual[axis]).length;
  return range(runCount).every((run) => differences(run) <= 1) ? usual : null;
}

/** What a choice of alternatives on some axes has that the baseline has not. */
function differenceText(chosen, alternatives) {
  const changed = range(chosen.length).filter((index) => alternatives[index] !== baseline[chosen[index]]);
  const words = changed.map((index) => {
    const { name, labels } = axes[chosen[index]];
    return alternatives[index] < 0 ? `without ${name}` : `${name} ${unitText(labels[alternatives[index]])}`;
  });
  return words.join(", ") || "baseline";
}

/** Names for some runs that tell them apart in few words, as a function of the run. */
function namesOf(list) {
  const all = range(axes.length);
  if (baseline)
    return (run) =>
      differenceText(
        all,
        all.map((axis) => runs.choice[axis][run]),
      );
  const differing = all.filter((axis) => new Set(list.map((run) => runs.choice[axis][run])).size > 1);
  const word = (axis, run) => {
    if (!isNumeric(axis)) return alternativeOf(axis, run);
    const isSampled = axes[axis].spacing === "sampled"; // its labels have more digits than anybody reads
    return `${axes[axis].name} ${isSampled ? numberText(placeOf(axis, run), 3) : unitText(alternativeOf(axis, run))}`;
  };
  const words = (run) => differing.filter((axis) => runs.choice[axis][run] >= 0).map((axis) => word(axis, run));
  return (run) => words(run).join(", ") || `run ${run}`;
}

/** A formulation in words. */
const lineName = (line) =>
  baseline ? differenceText(report.line_axes, lines[line].choice) : unitText(lines[line].label);

/** What a run can have cost, by name. */
const costs = {
  "solve time": { title: "Solve time (s)", of: (run) => runs.solve_seconds[run] },
  "set-up and solve time": {
    title: "Set-up and solve time (s)",
    of: (run) => sumOf(runs.setup_seconds[run], runs.solve_seconds[run]),
  },
  iterations: { title: "Iterations", of: (run) => runs.iterations[run] },
  factorizations: { title: "Factorizations", of: (run) => runs.factorizations[run] },
  unknowns: { title: "Unknowns", of: (run) => runs.unknowns[run] },
};
const sumOf = (a, b) => (isKnown(a) && isKnown(b) ? a + b : null);

function countBy(items, key) {
  const counts = new Map();
  for (const item of items) counts.set(key(item), (counts.get(key(item)) ?? 0) + 1);
  return counts;
}

/** Items by what `key` says of them, the largest group first. */
function groupBy(items, key) {
  const groups = new Map();
  for (const item of items) {
    const name = key(item);
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(item);
  }
  return [...groups].sort((a, b) => b[1].length - a[1].length);
}

function quantile(sorted, share) {
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  const above = Math.min(below + 1, sorted.length - 1);
  return sorted[below] + (at - below) * (sorted[above] - sorted[below]);
}

function median(values) {
  return values.length
    ? quantile(
        [...values].sort((a, b) => a - b),
        0.5,
      )
    : null;
}

/** At most so many of the items, evenly spread over them. */
function spreadOver(items, most) {
  if (items.length <= most) return items;
  return range(most).map((index) => items[Math.round((index * (items.length - 1)) / (most - 1))]);
}

/** [smallest, largest]; a spread of 10 000 arguments would be too many. */
function extent(values) {
  let low = Infinity,
    high = -Infinity;
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}
