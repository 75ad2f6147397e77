// Elements of the document. Text from a report only ever becomes text, never markup.

/** element("td", { class: "number" }, "1.5"): properties that start with "on" are listeners, null ones are left out. */
function element(name, properties = {}, ...children) {
  return fill(document.createElement(name), properties, children);
}

function drawing(name, properties = {}, ...children) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", name), properties, children);
}

function fill(made, properties, children) {
  for (const [key, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

function picker(label, options, chosen, onPick) {
  const select = element(
    "select",
    { onchange: () => onPick(select.value) },
    options.map(([value, text]) => element("option", { value, selected: String(value) === String(chosen) }, text)),
  );
  return element("label", { class: "picker" }, element("span", {}, label), select);
}

function button(text, onclick, properties = {}) {
  return element("button", { type: "button", onclick, ...properties }, text);
}

function table(columns, rows, properties = {}) {
  const isNumber = (cell) => typeof cell === "number" || cell === null;
  const cell = (value) =>
    element("td", { class: isNumber(value) ? "number" : null }, value instanceof Node ? value : cellText(value));
  return element(
    "table",
    properties,
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        columns.map((column) => element("th", { scope: "col" }, column)),
      ),
    ),
    element(
      "tbody",
      {},
      rows.map((row) => element("tr", {}, row.map(cell))),
    ),
  );
}

const tableFrame = (content, label) =>
  element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": label }, content);

function download(name, text) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address));
}

/** Runs as links that select them, the first few of many. */
function runLinks(list, most = 20) {
  const links = list
    .slice(0, most)
    .map((run) => button(`run ${run}`, () => select(run), { class: "link", title: describeRun(run) }));
  const spaced = links.flatMap((link) => [link, " "]);
  return list.length > most ? [...spaced, `and ${wholeText(list.length - most)} more`] : spaced;
}
