// Where the energy of a run is: its terms on top of each other, of either sign.

const mostEnergyRuns = 40;

function buildEnergies(root) {
  const figure = addFigure(root, "energies");
  return () => drawEnergies(figure);
}

/** Of each formulation the finest run shown, the recommended ones first; without a mesh all runs. Of many, some. */
function energyRuns() {
  const has = (run) => report.energies.some(({ values }) => isKnown(values[run]));
  const groups = shownGroups().sort((a, b) => byRecommendation(a.line, b.line));
  const finest = groups.flatMap(({ line, runs: list }) => {
    const known = list.filter(has);
    return line >= 0 && report.along !== null ? known.slice(-1) : known;
  });
  return { chosen: spreadOver(finest, mostEnergyRuns), count: finest.length };
}

function drawEnergies(figure) {
  const { chosen, count } = energyRuns();
  const nameOf = namesOf(chosen);
  const label = (run) => (converged(run) ? nameOf(run) : `✕ ${nameOf(run)}`);
  figure.showTitle("Energy by term");
  const options = baseOptions();
  Object.assign(options, { indexAxis: "y", interaction: { mode: "y", intersect: false } });
  options.scales = {
    x: linearScale("Energy (N mm)", { stacked: true }),
    y: scaleOf("", {
      type: "category",
      stacked: true,
      title: { display: false },
      ticks: { autoSkip: false, callback: (value) => barLabel(label(chosen[value]), figure) },
    }),
  };
  options.plugins.tooltip.callbacks = {
    title: ([item]) =>
      item
        ? [
            `run ${chosen[item.dataIndex]}: ${runs.status[chosen[item.dataIndex]]}`,
            ...wrapped(describeRun(chosen[item.dataIndex]), 60),
          ]
        : "",
    label: (item) => `${item.dataset.label}: ${numberText(item.raw.x)} N mm`,
  };
  const datasets = report.energies.map(({ term, values }, index) => ({
    label: term,
    backgroundColor: termColours[index % termColours.length],
    borderColor: pageColour("ground"),
    borderWidth: 1,
    maxBarThickness: 20,
    data: chosen.map((run, place) => ({ x: values[run], y: place, run })),
  }));
  figure.showChart(
    { type: "bar", data: { labels: chosen.map((_, place) => place), datasets }, options },
    chosen.length * 30 + 80,
  );
  figure.legend.replaceChildren(
    ...report.energies.map(({ term }, index) =>
      element(
        "span",
        { class: "entry-text" },
        element("i", { class: "dot", style: `background: ${termColours[index % termColours.length]}` }),
        term,
      ),
    ),
  );
  const which = report.along === null ? "" : `Of each formulation its finest run shown, by ${axes[report.along].name}.`;
  const failed = chosen.filter((run) => !converged(run));
  figure.showNote(
    which,
    count > chosen.length
      ? `${chosen.length} of ${counted(count, "run")}, evenly spread; filters bring out the others.`
      : "",
    failed.length ? "✕ before a name: did not converge." : "",
  );
  figure.showData(
    ["run", ...axes.map(({ column }) => column), ...report.energies.map(({ term }) => `${term} (N mm)`)],
    () =>
      chosen.map((run) => [
        run,
        ...axes.map((_, axis) => valueOf(axis, run)),
        ...report.energies.map(({ values }) => values[run]),
      ]),
  );
}
