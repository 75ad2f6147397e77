// Charts of runs as points: a line per formulation, what did not converge crossed.

const mostPoints = 4000;
const mostLegendEntries = 24;
const longestName = 72; // in a legend, in characters
const crowd = 16; // from so many lines on, those that no headline speaks of are faint

// The formulations that the most important headline speaks of: they are drawn above the others.
const recommended = new Set(report.headlines.find(({ kind }) => kind === "recommendation")?.lines ?? []);
const isLineShown = (line) => lines[line].runs.some((run) => view.isShown[run]);
const byRecommendation = (lineA, lineB) => recommended.has(lineB) - recommended.has(lineA);

// So many lines have a colour each. Of more, those that differ in numbers alone are a family: of one colour, in shades,
// and one entry of the legend.
const mostColours = 8;
const families = findFamilies(); // [{name, lines, by}]: lines by their numbers, `by` the axes of these
const familyOfLine = new Int32Array(lines.length);
families.forEach(({ lines: members }, family) =>
  members.forEach((line) => {
    familyOfLine[line] = family;
  }),
);

function findFamilies() {
  const alone = range(lines.length).map((line) => ({ name: lineName(line), lines: [line], by: [] }));
  const places = range(report.line_axes.length);
  const numeric = places.filter((place) => isNumeric(report.line_axes[place]));
  if (lines.length <= mostColours || !numeric.length || baseline) return alone;
  const words = places.filter((place) => !numeric.includes(place));
  const numberOf = (line, place) => axes[report.line_axes[place]].numbers[lines[line].choice[place]] ?? -Infinity;
  const compare = (a, b) => numeric.map((place) => numberOf(a, place) - numberOf(b, place)).find((sign) => sign) ?? 0;
  const keyed = new Map();
  for (const line of range(lines.length)) {
    const key = words.map((place) => lines[line].choice[place]).join();
    keyed.set(key, [...(keyed.get(key) ?? []), line]);
  }
  return [...keyed.values()].map((members) => {
    const ordered = members.sort(compare);
    const varying = numeric.filter((place) => new Set(ordered.map((line) => lines[line].choice[place])).size > 1);
    return { name: familyName(ordered, words, numeric), lines: ordered, by: varying.map((at) => report.line_axes[at]) };
  });
}

/** "planar, T = 1 N … 20 N" */
function familyName(members, words, numeric) {
  if (members.length === 1) return lineName(members[0]);
  const labelOf = (line, place) => unitText(axes[report.line_axes[place]].labels[lines[line].choice[place]] ?? "–");
  const ends = (place) => {
    const { numbers, unit } = axes[report.line_axes[place]];
    const [low, high] = extent(members.map((line) => numbers[lines[line].choice[place]]).filter(isKnown));
    if (low > high) return unknownText;
    return `${low === high ? "" : `${numberText(low)} … `}${numberText(high)} ${unitText(unit)}`.trim();
  };
  return [
    ...words.map((place) => labelOf(members[0], place)),
    ...numeric.map((place) => `${axes[report.line_axes[place]].name} = ${ends(place)}`),
  ].join(", ");
}

/** What the shades of a family mean; "" where no formulation shown has any. */
function shadeWords(series) {
  const drawn = new Set(series.map(({ line }) => line));
  const by = new Set(
    families.filter(({ lines: members }) => members.some((line) => drawn.has(line))).flatMap((family) => family.by),
  );
  if (!by.size) return "";
  return `Shades: ${[...by].map((axis) => axes[axis].name).join(", then ")}, the stronger the larger.`;
}

/** The runs shown as groups to be drawn: formulations, and last what belongs to none. */
function shownGroups() {
  const groups = lines.map((line, index) => ({
    line: index,
    label: lineName(index),
    runs: line.runs.filter((run) => view.isShown[run]),
  }));
  const others = view.runs.filter((run) => lineOfRun[run] < 0);
  groups.push({ line: -1, label: lines.length ? "of no formulation" : "runs", runs: others });
  return groups.filter((group) => group.runs.length);
}

/** Every so-maniest group, or run where groups are few, so that a chart stays quick; a note says so. */
function thinned(groups) {
  const count = groups.reduce((sum, group) => sum + group.runs.length, 0);
  if (count <= mostPoints) return { groups, note: "" };
  const step = Math.ceil(count / mostPoints);
  if (groups.length >= 2 * step) {
    const kept = groups.filter((group, index) => index % step === 0 || recommended.has(group.line));
    const share = `${wholeText(kept.length)} of ${counted(groups.length, "formulation")}`;
    return { groups: kept, note: `Drawn are ${share}; filters bring out the others.` };
  }
  const kept = groups.map((group) => ({ ...group, runs: group.runs.filter((_, index) => index % step === 0) }));
  return { groups: kept, note: `Drawn is one in ${step} of ${counted(count, "run")}; filters bring out the others.` };
}

/**
 * Points of the runs shown. `xOf(run)`, `yOf(run)`: null where not known. What an axis cannot hold is kept at its rim:
 * a run that failed without a value at the upper, a 0 on a logarithmic axis (`log.y`) at the lower one.
 */
function pointsOf(groups, xOf, yOf, log) {
  const missing = [];
  const place = (run) => {
    const x = xOf(run);
    const y = yOf(run);
    if (!isKnown(x) || (log.x && x <= 0)) return null;
    if (!isKnown(y)) return converged(run) ? null : { x, y: null, run, rim: "upper" };
    if (!log.y || y > 0) return { x, y, run };
    return y === 0 ? { x, y, run, rim: "lower" } : null;
  };
  const series = groups.map((group) => {
    const points = [];
    for (const run of group.runs) {
      const point = place(run);
      if (point) points.push(point);
      else missing.push(run);
    }
    return { ...group, points };
  });
  moveToRims(series, log);
  return { series, missing };
}

function moveToRims(series, log) {
  const points = series.flatMap((group) => group.points);
  const known = points.filter(({ rim }) => !rim).map(({ y }) => y);
  const [low, high] = log.y ? logRange(known) : linearRims(known);
  for (const point of points) {
    if (point.rim) point.y = point.rim === "upper" ? high : low;
  }
}

/** Clear of all values, so that nothing at the rim is taken for one. */
function linearRims(values) {
  if (!values.length) return [0, 1];
  const [low, high] = extent(values);
  const air = 0.08 * (high - low || Math.abs(high) || 1);
  return [low - air, high + air];
}

function datasetsOf(series, connected) {
  return series
    .flatMap((group) => {
      const style = lineStyle(group.line);
      const isEmphasized = recommended.has(group.line);
      const isFaint = series.length > crowd && !isEmphasized;
      const colour = isFaint && recommended.size ? `${style.colour}66` : style.colour;
      const common = { borderColor: colour, line: group.line, order: isEmphasized ? 0 : 1 };
      const radius = isFaint || group.points.length > 500 ? 2.5 : isEmphasized ? 6 : 4.5;
      return [
        {
          ...common,
          label: group.label,
          data: group.points.filter(({ run }) => converged(run)),
          showLine: connected && group.line >= 0,
          borderDash: isEmphasized ? [] : style.dash,
          borderWidth: isEmphasized ? 4 : isFaint ? 1 : 2,
          pointStyle: style.marker,
          backgroundColor: colour,
          pointBackgroundColor: colour,
          pointBorderColor: colour,
          pointBorderWidth: ["star", "cross"].includes(style.marker) ? 2 : 0,
          radius,
          hoverRadius: radius + 3,
          hitRadius: 5,
        },
        {
          ...common,
          label: `${group.label}: not converged`,
          data: group.points.filter(({ run }) => !converged(run)),
          showLine: false,
          clip: false,
          pointStyle: "crossRot",
          borderWidth: 2,
          radius: radius + 1,
          hoverRadius: radius + 4,
          hitRadius: 5,
        },
      ];
    })
    .filter((dataset) => dataset.data.length);
}

/**
 * Draws runs as points, lines in the order of their runs or `byX`. `scales(series)` gives the axes once it is known what
 * they must hold; `tip(run)` the words.
 */
function drawPoints(figure, { xOf, yOf, log, connected, byX = false, scales, tip, plugins = [] }) {
  const { groups, note } = thinned(shownGroups());
  const { series, missing } = pointsOf(groups, xOf, yOf, log);
  if (byX) series.forEach((group) => group.points.sort((a, b) => a.x - b.x));
  const points = series.flatMap((group) => group.points);
  const options = baseOptions();
  options.scales = scales(points);
  options.plugins.tooltip.callbacks = {
    title: (items) => (items.length ? wrapped(items[0].dataset.label, 60) : ""),
    label: (item) => tip(item.raw.run),
  };
  figure.showChart({
    type: "scatter",
    data: { datasets: datasetsOf(series, connected) },
    options,
    plugins: [selectionRing, ...plugins],
  });
  const atLower = points.filter(({ rim }) => rim === "lower").length;
  const atUpper = points.filter(({ rim }) => rim === "upper").length;
  figure.showNote(
    note,
    shadeWords(series),
    series.some(({ line }) => recommended.has(line)) ? "Thick, ★: recommended." : "",
    atLower ? `At the lower rim: ${counted(atLower, "point")} of exactly 0.` : "",
    points.some(({ run }) => !converged(run)) ? "Crosses: runs that did not converge." : "",
    atUpper ? `At the upper rim: ${counted(atUpper, "failure")} without a value.` : "",
    missing.length
      ? `Without a point for want of a value: ${counted(missing.length, "run")} (${statusWords(missing)}).`
      : "",
  );
  return series;
}

/** "5 converged, 2 stalled". */
function statusWords(list) {
  return [...countBy(list, (run) => runs.status[run])]
    .map(([status, count]) => `${wholeText(count)} ${status}`)
    .join(", ");
}

/** A text in lines of about that length, as canvases do not break any. */
function wrapped(text, length) {
  const rows = [""];
  for (const word of text.split(/(?<=[\s/,-])/)) {
    if (rows.at(-1) && rows.at(-1).length + word.length > length) rows.push("");
    rows[rows.length - 1] += word;
  }
  return rows.map((row) => row.trim());
}

/** What stands along a line, in the words of a tooltip. */
const alongText = (run) =>
  report.along === null ? `run ${run}` : `${axes[report.along].name} = ${alternativeOf(report.along, run)}`;

/** Formulations as buttons that show and hide them, everywhere. */
function drawLegend(holder) {
  if (lines.length < 2) return;
  // What only the legend hides stays in it, to be shown again.
  const isListed = (line) => isLineShown(line) || view.hiddenLines.has(line);
  const listed = families.filter((family) => family.lines.some(isListed));
  const count = holder.dataset.all ? listed.length : Math.min(listed.length, mostLegendEntries);
  const isRecommended = (family) => family.lines.some((line) => recommended.has(line));
  const ordered = listed.sort((a, b) => isRecommended(b) - isRecommended(a));
  const entries = ordered.slice(0, count).map(legendEntry);
  if (count < listed.length) {
    const showAll = () => {
      holder.dataset.all = "true";
      drawLegend(holder);
    };
    entries.push(button(`and ${wholeText(listed.length - count)} more`, showAll, { class: "link" }));
  }
  holder.replaceChildren(...entries);
}

function legendEntry({ name, lines: members }) {
  const failures = members.flatMap((line) => lines[line].runs).filter((run) => !converged(run)).length;
  const isHidden = members.every((line) => view.hiddenLines.has(line));
  const flip = () => {
    for (const line of members) view.hiddenLines[isHidden ? "delete" : "add"](line);
    changed();
  };
  const entry = button("", flip, {
    class: "entry",
    "aria-pressed": String(!isHidden),
    title: `${name}: show or hide`,
  });
  entry.append(swatch(members.at(-1)), element("span", { class: "name" }, shortened(name, longestName)));
  if (members.some((line) => recommended.has(line)))
    entry.append(element("span", { class: "badge", title: "recommended" }, "★"));
  if (failures)
    entry.append(element("span", { class: "failures", title: "runs that did not converge" }, `✕ ${failures}`));
  return entry;
}

/** The columns of runs drawn as points, for their data. */
function pointData(series, columns) {
  const names = ["run", "formulation", "status", ...axes.map(({ column }) => column), ...columns.map(([name]) => name)];
  return [
    names,
    () =>
      series.flatMap((group) =>
        group.points.map(({ run }) => [
          run,
          group.label,
          runs.status[run],
          ...axes.map((_, axis) => valueOf(axis, run)),
          ...columns.map(([, of]) => of(run)),
        ]),
      ),
  ];
}

/** What stands in a table for the axis: its number, or else its name. */
function valueOf(axis, run) {
  const place = placeOf(axis, run);
  return place === null || isNumeric(axis) ? place : alternativeOf(axis, run);
}
