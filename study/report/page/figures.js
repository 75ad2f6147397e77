// A figure: a heading, controls of its own, the drawing, a note, and its data one click away.

const figures = {}; // by name

const mostRowsShown = 500;

/** `canvas`: whether Chart.js draws in it. What it shows is given by showChart(), or put into `box`, and showData(). */
function addFigure(parent, name, { title = "", height = 380, canvas = true, level = 3 } = {}) {
  const heading = element(`h${level}`, { id: `figure-${name}` }, title);
  const tools = element("div", { class: "tools" });
  const box = element("div", { class: canvas ? "chart" : "drawing", style: canvas ? `height: ${height}px` : null });
  const legend = element("div", { class: "legend" });
  const note = element("p", { class: "note muted" });
  const { disclosure, showData } = dataDisclosure(name);
  const head = element("div", { class: "figure-head" }, heading, tools);
  const root = element(
    "figure",
    { class: "figure", "aria-labelledby": heading.id },
    head,
    box,
    legend,
    note,
    disclosure,
  );
  parent.append(root);

  const figure = { name, root, heading, tools, box, legend, note, chart: null, showData };
  figure.showChart = (config, ownHeight = height) => {
    figure.chart?.destroy();
    box.style.height = `${ownHeight}px`;
    const surface = element("canvas", {
      role: "img",
      "aria-label": `${heading.textContent}; its points are in the table below`,
    });
    box.replaceChildren(surface);
    figure.chart = new Chart(surface, config);
  };
  figure.showElements = (...elements) => {
    figure.chart?.destroy();
    figure.chart = null;
    box.style.height = "auto";
    box.replaceChildren(...elements);
  };
  figure.showTitle = (text) => {
    heading.textContent = text;
  };
  figure.showNote = (...parts) => {
    note.replaceChildren(parts.filter(Boolean).join(" "));
  };
  figures[name] = figure;
  return figure;
}

/** `showData(columns, rows)`: rows is a function, as nobody may ask for them. */
function dataDisclosure(name) {
  let columns = [],
    rows = () => [];
  const holder = element("div", {});
  const list = () => {
    const all = rows();
    const shown = all.slice(0, mostRowsShown);
    holder.replaceChildren(
      button("Download CSV", () => download(`${study.name || "study"}-${name}.csv`, csvText(columns, rows())), {
        class: "download",
      }),
      element(
        "span",
        { class: "muted" },
        all.length > shown.length
          ? ` The first ${wholeText(shown.length)} of ${wholeText(all.length)} rows; the file has all.`
          : ` ${counted(all.length, "row")}.`,
      ),
      tableFrame(table(columns, shown), "Data"),
    );
  };
  const disclosure = element(
    "details",
    {
      class: "data",
      ontoggle: () => {
        if (disclosure.open) list();
      },
    },
    element("summary", {}, "Data"),
    holder,
  );
  const showData = (newColumns, newRows) => {
    [columns, rows] = [newColumns, newRows];
    if (disclosure.open) list();
  };
  return { disclosure, showData };
}
