// Every run that did not converge, by status and reason.

/** [{status, reason, alike, list}] of these runs, the most frequent first; `alike`: reasons differ in their numbers. */
function outcomes(list) {
  return groupBy(list, (run) => `${runs.status[run]}\n${withoutNumbers(runs.reason[run] ?? "")}`).map(([, group]) => ({
    status: runs.status[group[0]],
    reason: runs.reason[group[0]] || "without a reason",
    alike: new Set(group.map((run) => runs.reason[run])).size > 1,
    list: group,
  }));
}

const withoutNumbers = (text) => text.replace(/\d+(\.\d+)?(e[-+]?\d+)?/g, "#");

const failedRuns = range(runCount).filter((run) => !converged(run));

function buildFailures(root) {
  const figure = addFigure(root, "failures", { canvas: false });
  return () => {
    const shown = view.runs.filter((run) => !converged(run));
    const groups = outcomes(shown);
    const hidden = failedRuns.length - shown.length;
    figure.showTitle(`${counted(shown.length, "run")} of ${wholeText(view.runs.length)} did not converge`);
    figure.showElements(
      tableFrame(
        table(
          ["runs", "status", "reason", "which"],
          groups.map(({ status, reason, alike, list }) => [
            list.length,
            statusBadge(status),
            alike
              ? element("span", {}, reason, element("span", { class: "muted" }, ` (numbers of run ${list[0]})`))
              : reason,
            element("span", {}, runLinks(list, 8)),
          ]),
          { class: "failures-table" },
        ),
        "Failures",
      ),
    );
    figure.showNote(hidden ? `Hidden by filters: ${wholeText(hidden)} more.` : "", commonWords(shown));
    figure.showData(["run", "status", "reason", ...axes.map(({ column }) => column)], () =>
      groups
        .flatMap(({ list }) => list)
        .map((run) => [run, runs.status[run], runs.reason[run], ...axes.map((_, axis) => valueOf(axis, run))]),
    );
  };
}

/** What all failures share and not every run has. */
function commonWords(failed) {
  if (failed.length < 2) return "";
  const shared = range(axes.length).filter((axis) => {
    const first = runs.choice[axis][failed[0]];
    return (
      failed.every((run) => runs.choice[axis][run] === first) &&
      view.runs.some((run) => runs.choice[axis][run] !== first)
    );
  });
  return shared.length ? `All of them have ${unitText(describeRun(failed[0], shared))}.` : "";
}

function statusBadge(status) {
  return element(
    "span",
    { class: "status" },
    element("i", { class: "dot", style: `background: ${statusColour(status)}` }),
    status,
  );
}

/** How all runs ended, as bars. */
function outcomeBars() {
  const groups = outcomes(view.runs);
  const most = Math.max(...groups.map(({ list }) => list.length), 1);
  return element(
    "div",
    { class: "outcomes" },
    groups
      .slice(0, 12)
      .map(({ status, reason, list }) =>
        element(
          "div",
          { class: "outcome" },
          element("p", {}, element("b", {}, `${wholeText(list.length)} ${status}`), `: ${reason}`),
          element(
            "div",
            { class: "track", "aria-hidden": "true" },
            element("i", { style: `width: ${(100 * list.length) / most}%; background: ${statusColour(status)}` }),
          ),
        ),
      ),
  );
}
