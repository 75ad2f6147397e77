// What a change of one alternative does to a quantity, all else being equal.

const mostBars = 20;

function effectName({ axis, from, to }) {
  const { name, labels } = axes[axis];
  return `${name}: ${from < 0 ? "baseline" : unitText(labels[from])} → ${unitText(labels[to])}`;
}

function buildEffects(root) {
  const words = element("p", { class: "lead" });
  root.append(words);
  const figure = addFigure(root, "effects");
  return () => {
    const own = ownEffects();
    words.textContent = own.length ? effectWords(own[0]) : "";
    drawEffects(figure);
  };
}

const ownEffects = () => report.effects.filter(({ quantity }) => quantity === view.quantity);

function effectWords({ axis, from, to, quantity, mean, relative, pairs }) {
  const { name, labels } = axes[axis];
  const { unit } = quantities[quantity];
  const change = `${signedText(mean, 3)}${unit ? ` ${unitText(unit)}` : ""}`;
  const share = isKnown(relative) ? ` (${signedText(100 * relative, 3)} % of its mean size)` : "";
  return (
    `What changed ${quantityName(quantity)} most: ` +
    `${name} from ${from < 0 ? "the baseline" : unitText(labels[from])} to ${unitText(labels[to])}, ` +
    `by ${change}${share} on average over ${counted(pairs, "pair")}.`
  );
}

function drawEffects(figure) {
  const own = ownEffects();
  const shown = own.slice(0, mostBars);
  const title = `Change of ${quantityTitle(view.quantity)}`;
  figure.showTitle(`Effects on ${quantityName(view.quantity)}, the largest first`);
  const options = baseOptions();
  Object.assign(options, { indexAxis: "y", interaction: { mode: "y", intersect: false } });
  options.scales = {
    x: linearScale(title, {
      suggestedMin: Math.min(...shown.map(({ low }) => low ?? 0), 0),
      suggestedMax: Math.max(...shown.map(({ high }) => high ?? 0), 0),
    }),
    y: scaleOf("", {
      type: "category",
      title: { display: false },
      ticks: { autoSkip: false, callback: (value) => changeLabel(effectName(shown[value]), figure) },
    }),
  };
  options.plugins.tooltip.callbacks = {
    title: ([item]) => (item ? wrapped(effectName(shown[item.dataIndex]), 60) : ""),
    label: ({ dataIndex }) => effectTip(shown[dataIndex]),
  };
  const bars = shown.map((effect, index) => ({ x: effect.mean, y: index, run: effect.largest_run }));
  figure.showChart(
    {
      type: "bar",
      data: {
        labels: shown.map((_, index) => index),
        datasets: [
          {
            label: title,
            data: bars,
            backgroundColor: shown.map(({ mean }) => pageColour(mean < 0 ? "negative" : "positive")),
            maxBarThickness: 22,
          },
        ],
      },
      options,
      plugins: [intervalMarks(shown)],
    },
    Math.max(shown.length * 34, 60) + 70,
  );
  figure.showNote(
    "Whiskers: 95 % intervals of the mean.",
    own.some(({ pairs }) => pairs < 2) ? "Bars without one are of a single pair." : "",
    own.length > shown.length ? `The ${shown.length} largest of ${own.length}; the others are in the data.` : "",
    isFiltered() ? "Effects are of all runs, whatever the filters." : "",
  );
  figure.showData(["axis", "from", "to", "pairs", "mean", "low", "high", "relative", "largest", "largest run"], () =>
    own.map((effect) => [
      axes[effect.axis].name,
      axes[effect.axis].labels[effect.from] ?? "baseline",
      axes[effect.axis].labels[effect.to],
      effect.pairs,
      effect.mean,
      effect.low,
      effect.high,
      effect.relative,
      effect.largest,
      effect.largest_run,
    ]),
  );
}

function effectTip({ mean, low, high, pairs, relative, largest, largest_run: run }) {
  return [
    `mean change: ${signedText(mean)} [${numberText(low)}, ${numberText(high)}]`,
    `relative: ${isKnown(relative) ? percentText(relative) : unknownText}`,
    `pairs: ${pairs}`,
    `largest: ${signedText(largest)}${isKnown(run) ? ` (run ${run})` : ""}`,
  ];
}

const labelLength = (figure) => Math.max(20, Math.floor(figure.box.clientWidth / 24));

/** "contact: node-wise → segment-wise" in one line or, broken at the arrow, in two. */
function changeLabel(text, figure) {
  const length = labelLength(figure);
  if (text.length <= length) return text;
  return text.split(/ (?=→ )/).map((row) => shortened(row, length));
}

/** A label that leaves most of the width to the bars, in two lines at most. */
function barLabel(text, figure) {
  const length = labelLength(figure);
  const rows = wrapped(text, length);
  return rows.length <= 2 ? rows : [shortened(rows[0], length), shortened(rows.slice(1).join(" "), length)];
}

/** Whiskers from low to high over horizontal bars. */
const intervalMarks = (effects) => ({
  id: "intervalMarks",
  afterDatasetsDraw({ ctx, scales, getDatasetMeta }) {
    ctx.save();
    ctx.strokeStyle = pageColour("ink");
    ctx.lineWidth = 1.5;
    effects.forEach(({ low, high }, index) => {
      if (!isKnown(low) || !isKnown(high)) return;
      const [from, to, y] = [
        scales.x.getPixelForValue(low),
        scales.x.getPixelForValue(high),
        scales.y.getPixelForValue(index),
      ];
      ctx.beginPath();
      ctx.moveTo(from, y - 5);
      ctx.lineTo(from, y + 5);
      ctx.moveTo(from, y);
      ctx.lineTo(to, y);
      ctx.moveTo(to, y - 5);
      ctx.lineTo(to, y + 5);
      ctx.stroke();
    });
    ctx.restore();
  },
});
