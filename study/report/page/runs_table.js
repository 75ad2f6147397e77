// All runs, one row each. Only the rows in sight are elements, so that ten thousand scroll like ten.

const rowHeight = 28; // px, as page.css has it
const frameHeight = 480; // px, at most
const rowsBeyond = 10; // drawn above and below what is in sight
const collator = new Intl.Collator("en", { numeric: true });

function runColumns() {
  const numbers = (name, values) => ({ name, of: (run) => values[run], isNumber: true });
  return [
    { name: "run", of: (run) => run, isNumber: true },
    ...axes.map((_, axis) => ({ name: axisTitle(axis), of: (run) => valueOf(axis, run), isNumber: isNumeric(axis) })),
    { name: "status", of: (run) => runs.status[run] },
    ...quantities.flatMap((quantity, index) => [
      numbers(quantityTitle(index), quantity.values),
      ...(quantity.errors ? [numbers(`error of ${quantityName(index)}`, quantity.errors)] : []),
    ]),
    numbers("solve time (s)", runs.solve_seconds),
    numbers("set-up time (s)", runs.setup_seconds),
    numbers("unknowns", runs.unknowns),
    numbers("iterations", runs.iterations),
    numbers("factorizations", runs.factorizations),
    numbers("epochs", runs.epochs),
    numbers("wall crossed by (mm)", runs.max_penetration_dense_mm),
    numbers("smallest stretch", runs.min_stretch),
    { name: "second order", of: (run) => runs.second_order[run] },
    { name: "reason", of: (run) => runs.reason[run] },
    { name: "hash", of: (run) => runs.hash[run], width: 14 },
  ].filter(({ of }) => range(runCount).some((run) => ![null, undefined, ""].includes(of(run))));
}

function buildRunsTable(root) {
  const columns = runColumns();
  const order = { column: 0, descending: false };
  let searched = "",
    listed = [];

  const search = element("input", {
    type: "search",
    placeholder: "any text of a row",
    oninput: () => {
      searched = search.value.trim().toLowerCase();
      list();
    },
  });
  const count = element("output", { class: "muted" });
  const save = button("Download CSV", () =>
    download(
      `${study.name || "study"}-runs.csv`,
      csvText(
        columns.map(({ name }) => name),
        listed.map((run) => columns.map(({ of }) => of(run))),
      ),
    ),
  );
  const headers = columns.map((column, index) =>
    element(
      "th",
      { scope: "col", class: column.isNumber ? "number" : null },
      button(column.name, () => sortBy(index), { title: `sort by ${column.name}` }),
    ),
  );
  const body = element("tbody", {});
  const frame = element(
    "div",
    { class: "rows", tabindex: "0", role: "region", "aria-label": "Runs", onscroll: () => drawRows() },
    element(
      "table",
      { "aria-rowcount": runCount + 1 },
      element(
        "colgroup",
        {},
        columns.map((column) => element("col", { style: `width: ${columnWidth(column)}ch` })),
      ),
      element("thead", {}, element("tr", {}, headers)),
      body,
    ),
  );
  root.append(
    element(
      "div",
      { class: "tools" },
      element("label", { class: "picker" }, element("span", {}, "Find"), search),
      save,
      count,
    ),
    frame,
  );

  const texts = [];
  const textOf = (run) =>
    (texts[run] ??= columns
      .map(({ of, isNumber }) => (isNumber ? `${of(run)} ${cellText(of(run))}` : of(run)))
      .join("\n")
      .toLowerCase());

  function sortBy(column) {
    order.descending = order.column === column && !order.descending;
    order.column = column;
    list();
  }

  function list() {
    const { of } = columns[order.column];
    listed = sorted(
      searched ? view.runs.filter((run) => textOf(run).includes(searched)) : view.runs,
      of,
      order.descending,
    );
    headers.forEach((header, index) =>
      header.setAttribute("aria-sort", index !== order.column ? "none" : order.descending ? "descending" : "ascending"),
    );
    count.textContent = counted(listed.length, "row");
    drawRows();
  }

  function drawRows() {
    const first = Math.max(0, Math.floor(frame.scrollTop / rowHeight) - rowsBeyond);
    const last = Math.min(listed.length, first + Math.ceil(frameHeight / rowHeight) + 2 * rowsBeyond);
    const gap = (rows) => element("tr", { "aria-hidden": "true", style: `height: ${rows * rowHeight}px` });
    body.replaceChildren(
      gap(first),
      ...listed.slice(first, last).map((run, index) => runRow(run, first + index, columns)),
      gap(listed.length - last),
    );
  }

  function showSelected() {
    const place = listed.indexOf(view.selected);
    const top = place * rowHeight;
    if (place >= 0 && (top < frame.scrollTop || top + 2 * rowHeight > frame.scrollTop + frame.clientHeight))
      frame.scrollTop = top - frameHeight / 2;
    drawRows();
  }

  selectionMarks.push(showSelected);
  bowstringReport.listedRuns = () => listed;
  return list;
}

const rowText = (value) => (typeof value === "number" ? numberText(value, 5) : cellText(value));

function runRow(run, place, columns) {
  const cell = ({ of, isNumber }) => {
    const text = rowText(of(run));
    return element("td", { class: isNumber ? "number" : null, title: text.length > 18 ? text : null }, text);
  };
  const [first, ...others] = columns;
  const mark = button(
    String(first.of(run)),
    (event) => {
      event.stopPropagation();
      select(view.selected === run ? null : run);
    },
    { class: "link", title: "mark in the plots" },
  );
  const classes = [view.selected === run ? "selected-row" : "", converged(run) ? "" : "failed-row"].join(" ").trim();
  return element(
    "tr",
    { class: classes || null, "aria-rowindex": place + 2, onclick: () => select(view.selected === run ? null : run) },
    element("td", { class: "number" }, mark),
    others.map(cell),
  );
}

/** In characters, by a sample of the rows. */
function columnWidth({ name, of, width }) {
  if (width) return width;
  const step = Math.max(1, Math.floor(runCount / 100));
  const longest = range(runCount)
    .filter((run) => run % step === 0)
    .reduce((most, run) => Math.max(most, cellText(of(run)).length), 0);
  return Math.min(Math.max(longest + 2, Math.min(name.length, 16) + 4), 36);
}

/** By what `of` says, numbers as numbers; what is not known comes last either way. */
function sorted(list, of, descending) {
  const isMissing = (key) => key === null || key === undefined || key === "";
  const compare = (a, b) => (typeof a === "number" && typeof b === "number" ? a - b : collator.compare(a, b));
  const keyed = list.map((run) => [of(run), run]);
  keyed.sort(([a, runA], [b, runB]) => {
    if (isMissing(a) || isMissing(b)) return isMissing(a) - isMissing(b) || runA - runB;
    return (descending ? compare(b, a) : compare(a, b)) || runA - runB;
  });
  return keyed.map(([, run]) => run);
}
