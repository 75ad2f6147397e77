// What the reader chose to see. Every section draws from it, and is drawn again when it changes.

const view = {
  quantity: 0,
  hidden: axes.map(() => new Set()), // alternatives, per axis
  between: axes.map(() => [null, null]), // numbers, per axis of many
  hiddenStatuses: new Set(),
  hiddenLines: new Set(),
  selected: null,
  runs: range(runCount), // what is left of them
  isShown: new Uint8Array(runCount).fill(1),
};

const sections = [];
const watchers = []; // what is always in sight, and so never waits
const selectionMarks = []; // what shows the selected run, but for the charts

function passesAxis(axis, run) {
  const alternative = runs.choice[axis][run];
  if (alternative < 0) return true;
  if (view.hidden[axis].has(alternative)) return false;
  const [low, high] = view.between[axis];
  if (low === null && high === null) return true;
  const number = axes[axis].numbers[alternative];
  return (low === null || number >= low) && (high === null || number <= high);
}

function passes(run) {
  return (
    !view.hiddenStatuses.has(runs.status[run]) &&
    !view.hiddenLines.has(lineOfRun[run]) &&
    axes.every((_, axis) => passesAxis(axis, run))
  );
}

const axisIsFiltered = (axis) => view.hidden[axis].size > 0 || view.between[axis].some((bound) => bound !== null);

function isFiltered() {
  return view.hiddenStatuses.size > 0 || view.hiddenLines.size > 0 || axes.some((_, axis) => axisIsFiltered(axis));
}

function showEverything() {
  view.hidden.forEach((alternatives) => alternatives.clear());
  view.between.forEach((bounds) => bounds.fill(null));
  view.hiddenStatuses.clear();
  view.hiddenLines.clear();
  changed();
}

function toggle(set, item) {
  if (!set.delete(item)) set.add(item);
  changed();
}

/** To be called after any change of the view. */
function changed() {
  view.runs = range(runCount).filter(passes);
  view.isShown.fill(0);
  for (const run of view.runs) view.isShown[run] = 1;
  redraw();
}

function redraw() {
  keepingFocus(() => {
    for (const watcher of watchers) watcher();
    for (const section of sections) {
      section.isDrawn = false;
      if (section.isNear) drawSection(section);
    }
  });
}

/** Marks a run in every plot and in the table; null unmarks. */
function select(run) {
  view.selected = run;
  keepingFocus(() => selectionMarks.forEach((mark) => mark()));
  for (const { chart } of Object.values(figures)) chart?.draw();
}

/** A figure makes its controls anew: whoever was at one by the keyboard is at its successor afterwards. */
function keepingFocus(action) {
  const holder = document.activeElement?.closest("figure, #runs");
  const controlsOf = () => [...holder.querySelectorAll("button, select, input")];
  const place = holder ? controlsOf().indexOf(document.activeElement) : -1;
  action();
  if (place >= 0 && !holder.contains(document.activeElement)) controlsOf()[place]?.focus({ preventScroll: true });
}

function drawSection(section) {
  if (section.isDrawn) return;
  section.isDrawn = true;
  section.draw();
}

// A section far below the fold costs nothing until it is scrolled to.
const nearness = new IntersectionObserver(
  (entries) => {
    for (const entry of entries) {
      const section = sections.find(({ root }) => root === entry.target);
      section.isNear = entry.isIntersecting;
      if (section.isNear) drawSection(section);
    }
  },
  { rootMargin: "400px" },
);

/** A section of the page; `build` gets its root and gives back what draws it, whenever the view changes. */
function addSection(id, title, build) {
  const root = element(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    element("h2", { id: `${id}-title` }, title),
  );
  document.getElementById("sections").append(root);
  const section = { id, title, root, draw: build(root), isDrawn: false, isNear: false };
  sections.push(section);
  nearness.observe(root);
}
