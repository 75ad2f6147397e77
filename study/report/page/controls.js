// The bar of controls: the quantity, what is filtered by axis and status, what is selected.

const mostToggles = 24;

function buildControls() {
  const holder = document.getElementById("controls");
  const count = element("output", { class: "shown-count" });
  const reset = button("Show all", showEverything, { class: "reset" });
  const selected = element("p", { class: "selected", hidden: true });
  const filters = [...axes.map((_, axis) => axisFilter(axis)), statusFilter()].filter(Boolean);
  const names = quantities.map((_, quantity) => [quantity, quantityTitle(quantity)]);
  if (names.length)
    holder.append(
      picker("Quantity", names, view.quantity, (quantity) => {
        view.quantity = Number(quantity);
        changed();
      }),
    );
  holder.append(...filters.map(({ root }) => root), reset, count, selected);
  closeOnLeaving(filters.map(({ root }) => root));
  selectionMarks.push(() => drawSelected(selected));
  return () => {
    filters.forEach(({ draw }) => draw());
    count.textContent =
      view.runs.length === runCount
        ? `all ${counted(runCount, "run")}`
        : `${wholeText(view.runs.length)} of ${counted(runCount, "run")}`;
    reset.hidden = !isFiltered();
  };
}

/** Opens a panel of boxes below its name. `draw` brings both to what the view says. */
function filterPanel(name, content, summary) {
  const state = element("span", { class: "state" });
  const root = element(
    "details",
    { class: "filter" },
    element("summary", {}, element("b", {}, name), " ", state),
    element("div", { class: "panel" }, content.root),
  );
  const draw = () => {
    const text = summary();
    state.textContent = text || "all";
    root.classList.toggle("active", text !== "");
    content.draw();
  };
  return { root, draw };
}

function toggles(labels, set) {
  const boxes = labels.map(([item]) => element("input", { type: "checkbox", onchange: () => toggle(set, item) }));
  const root = element(
    "div",
    {},
    labels.map(([, text], index) => element("label", { class: "toggle" }, boxes[index], text)),
  );
  const draw = () =>
    labels.forEach(([item], index) => {
      boxes[index].checked = !set.has(item);
    });
  return { root, draw };
}

function bounds(axis) {
  const numbers = axes[axis].numbers;
  const [low, high] = extent(numbers.filter(isKnown));
  const field = (index, name, standing) => {
    const input = element("input", {
      type: "number",
      step: "any",
      placeholder: numberText(standing),
      onchange: () => {
        view.between[axis][index] = input.value === "" ? null : Number(input.value);
        changed();
      },
    });
    return { input, label: element("label", {}, name, input) };
  };
  const fields = [field(0, "from ", low), field(1, "to ", high)];
  const draw = () =>
    fields.forEach(({ input }, index) => {
      input.value = view.between[axis][index] ?? "";
    });
  return {
    root: element(
      "div",
      { class: "bounds" },
      fields.map(({ label }) => label),
      axes[axis].unit,
    ),
    draw,
  };
}

function axisFilter(axis) {
  const { name, labels } = axes[axis];
  if (labels.length < 2) return null;
  const isLong = isNumeric(axis) && labels.length > mostToggles;
  const content = isLong
    ? bounds(axis)
    : toggles(
        labels.map((label, alternative) => [alternative, label]),
        view.hidden[axis],
      );
  return filterPanel(name, content, () => {
    if (!axisIsFiltered(axis)) return "";
    if (!isLong) return `${labels.length - view.hidden[axis].size} of ${labels.length}`;
    return view.between[axis].map((bound) => (bound === null ? "…" : numberText(bound))).join(" to ");
  });
}

function statusFilter() {
  const statuses = [...countBy(range(runCount), (run) => runs.status[run])].map(([status, count]) => [
    status,
    `${status} (${wholeText(count)})`,
  ]);
  if (statuses.length < 2) return null;
  return filterPanel("status", toggles(statuses, view.hiddenStatuses), () =>
    view.hiddenStatuses.size ? `${statuses.length - view.hiddenStatuses.size} of ${statuses.length}` : "",
  );
}

function drawSelected(holder) {
  const run = view.selected;
  holder.hidden = run === null;
  if (run === null) return;
  holder.replaceChildren(
    element("b", {}, `Run ${run}: `),
    `${describeRun(run)}: ${runs.status[run]} `,
    button("unmark", () => select(null), { class: "link" }),
  );
}

/** One panel at a time, none once the reader has moved on. */
function closeOnLeaving(panels) {
  addEventListener("click", (event) => {
    for (const panel of panels) if (!panel.contains(event.target)) panel.open = false;
  });
  addEventListener("keydown", (event) => {
    if (event.key === "Escape")
      panels.forEach((panel) => {
        panel.open = false;
      });
  });
}
