// How each formulation comes nearer to its limit along the mesh.

const readableVerdict = {
  converges: "✓ converges",
  "does not settle": "✕ does not settle",
  exact: "✓ exact",
  "too few": "– too few points",
};

function buildConvergence(root) {
  const { along } = report;
  let shows = "error";
  const figure = addFigure(root, "convergence");
  const orders = element("div", {});
  root.append(orders);

  return () => {
    const { quantity } = view;
    const canShowErrors = hasErrors(quantity);
    const showsErrors = canShowErrors && shows === "error";
    figure.tools.replaceChildren(
      canShowErrors
        ? picker(
            "Show",
            [
              ["error", "error"],
              ["value", "value"],
            ],
            shows,
            (chosen) => {
              shows = chosen;
              redraw();
            },
          )
        : "",
    );
    if (showsErrors) drawErrorsAlong(figure);
    else drawAgainst(figure, along);
    drawLegend(figure.legend);
    orders.replaceChildren(...orderTable(quantity));
  };
}

function drawErrorsAlong(figure) {
  const { along } = report;
  const { quantity } = view;
  figure.showTitle(`Error of ${quantityName(quantity)} against ${axes[along].name}`);
  const series = drawPoints(figure, {
    xOf: (run) => placeOf(along, run),
    yOf: (run) => errorOf(quantity, run),
    log: { y: true },
    connected: true,
    scales: (points) => ({
      x: axisScale(
        along,
        points.map(({ x }) => x),
        points.every(({ x }) => x > 0),
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
  figure.showData(...pointData(series, [["error", (run) => errorOf(quantity, run)]]));
}

/** The fitted orders of the formulations shown. */
function orderTable(quantity) {
  const fitted = range(lines.length).filter((line) => isLineShown(line) && lines[line].fits?.[quantity]);
  if (!fitted.length) return [];
  const row = (line) => {
    const fit = lines[line].fits[quantity];
    const isBad = fit.verdict === "does not settle";
    const interval =
      isKnown(fit.order_low) && isKnown(fit.order_high)
        ? `${numberText(fit.order_low, 3)} to ${numberText(fit.order_high, 3)}`
        : unknownText;
    return [
      element("span", { class: "with-swatch" }, swatch(line), lineName(line)),
      element("span", { class: isBad ? "bad" : "good" }, readableVerdict[fit.verdict] ?? fit.verdict),
      roundedTo(3, fit.order),
      interval,
      roundedTo(5, fit.limit),
      fit.text || "",
    ];
  };
  const columns = [
    "formulation",
    "verdict",
    "order",
    "95 % interval",
    withUnit("limit", quantities[quantity].unit),
    "in words",
  ];
  return [
    element("h3", {}, `Fitted orders of ${quantityName(quantity)}`),
    tableFrame(table(columns, fitted.map(row), { class: "orders" }), "Fitted orders"),
  ];
}
