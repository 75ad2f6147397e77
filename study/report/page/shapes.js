// Deformed curves over each other, with the forces between wire and wall.

const mostShapesAtFirst = 3;

function buildShapes(root) {
  const text = element("p", { class: "muted" }, report.shapes_text ?? "");
  root.append(text);
  if (!report.shapes.length) return () => {};
  const figure = addFigure(root, "shapes", { canvas: false });
  const chosen = new Set(range(Math.min(report.shapes.length, mostShapesAtFirst)));
  const plane = shapeWindow(figure, chosen);
  const nameOf = namesOf(report.shapes.map(({ run }) => run));
  return () => {
    figure.showTitle("Shapes and contact forces");
    plane.draw();
    figure.tools.replaceChildren(...shapeTools(plane));
    figure.legend.replaceChildren(
      ...range(report.shapes.length)
        .filter(isShapeShown)
        .map((index) => shapeEntry(nameOf(report.shapes[index].run), index, chosen)),
      ...shapeKeys(),
    );
    const largest = largestForce();
    figure.showNote(
      largest > 0 ? `The longest arrow: ${numberText(largest, 3)} N.` : "",
      "Drag to move, Ctrl and the wheel to zoom.",
    );
    figure.showData(
      ["run", "curve", "kind", "point", "x (mm)", "y (mm)", "rest x (mm)", "rest y (mm)", "force (N)"],
      () => shapeRows(chosen),
    );
  };
}

const isShapeShown = (index) => view.isShown[report.shapes[index].run] === 1;

function shapeEntry(name, index, chosen) {
  const entry = button(
    "",
    () => {
      if (!chosen.delete(index)) chosen.add(index);
      redraw();
    },
    {
      class: "entry",
      "aria-pressed": String(chosen.has(index)),
      title: `${name}: show or hide`,
    },
  );
  entry.append(
    element("i", { class: "dot", style: `background: ${shapeColour(index)}` }),
    element("span", { class: "name" }, shortened(name, longestName)),
  );
  return entry;
}

/** The colour of the formulation's family, unless several shapes are of one. */
function shapeColour(index) {
  const familiesShown = report.shapes.map(({ run }) => familyOfLine[lineOfRun[run]] ?? -1);
  const isDistinct = new Set(familiesShown).size === familiesShown.length && !familiesShown.includes(-1);
  return styleOf(isDistinct ? familiesShown[index] : index).colour;
}

function shapeKeys() {
  const key = (kind, text) =>
    element(
      "span",
      { class: "entry-text" },
      drawing(
        "svg",
        { class: "swatch shape-key", viewBox: "0 0 30 14", "aria-hidden": "true" },
        drawing("line", { class: kind, x1: 1, x2: 29, y1: 7, y2: 7, stroke: "currentColor" }),
      ),
      text,
    );
  return [key("wire", "wire"), key("vessel", "vessel"), key("rest", "vessel at rest")];
}

function shapeRows(chosen) {
  return [...chosen]
    .filter(isShapeShown)
    .sort((a, b) => a - b)
    .flatMap((index) => {
      const { run, curves, contacts } = report.shapes[index];
      return [
        ...curves.flatMap(({ name, kind, points, rest }) =>
          points.map(([x, y], point) => [
            run,
            name,
            kind,
            point,
            x,
            y,
            rest?.[point]?.[0] ?? null,
            rest?.[point]?.[1] ?? null,
            null,
          ]),
        ),
        ...contacts.map(({ x, y, force_N: force }, point) => [run, "contact", "force", point, x, y, null, null, force]),
      ];
    });
}

/** A window onto the plane, in mm, with y upwards: what part of it is seen, and what is drawn in it. */
function shapeWindow(figure, chosen) {
  const picture = drawing("svg", {
    class: "shapes",
    role: "img",
    "aria-label": "Curves in the plane; their points are in the table below",
  });
  const scaleBar = element("div", { class: "scale-bar" });
  figure.box.append(element("div", { class: "shape-frame" }, picture, scaleBar));
  const all = boundsOf(report.shapes);
  let seen = { ...all };

  const place = () => {
    picture.setAttribute("viewBox", `${seen.x} ${seen.y} ${seen.width} ${seen.height}`);
    const pixels = picture.clientWidth
      ? Math.min(picture.clientWidth / seen.width, picture.clientHeight / seen.height)
      : 1;
    const length = roundLength(110 / pixels);
    scaleBar.replaceChildren(element("i", { style: `width: ${length * pixels}px` }), `${numberText(length)} mm`);
  };
  const draw = () => {
    picture.style.aspectRatio = `${Math.max(all.width, 1.2 * all.height)} / ${all.height}`;
    picture.replaceChildren(
      ...[...chosen].filter(isShapeShown).map((index) => shapeDrawing(report.shapes[index], shapeColour(index), all)),
    );
    place();
  };
  const zoom = (factor, x = seen.x + seen.width / 2, y = seen.y + seen.height / 2) => {
    seen = {
      x: x + (seen.x - x) * factor,
      y: y + (seen.y - y) * factor,
      width: seen.width * factor,
      height: seen.height * factor,
    };
    place();
  };
  const reset = () => {
    seen = { ...all };
    place();
  };
  const inPlane = (event) =>
    new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse());
  picture.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && !event.metaKey) return;
      event.preventDefault();
      const { x, y } = inPlane(event);
      zoom(event.deltaY > 0 ? 1.2 : 1 / 1.2, x, y);
    },
    { passive: false },
  );
  dragged(picture, inPlane, (dx, dy) => {
    seen.x -= dx;
    seen.y -= dy;
    place();
  });
  return { draw, zoom, reset };
}

/** Calls `move` with the way, in the plane, that the pointer drags what it holds. */
function dragged(picture, inPlane, move) {
  let held = null;
  picture.addEventListener("pointerdown", (event) => {
    held = inPlane(event);
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!held) return;
    const at = inPlane(event);
    move(at.x - held.x, at.y - held.y);
    held = inPlane(event);
  });
  for (const end of ["pointerup", "pointercancel"])
    picture.addEventListener(end, () => {
      held = null;
    });
}

function shapeTools({ zoom, reset }) {
  return [
    button("+", () => zoom(1 / 1.4), { "aria-label": "zoom in" }),
    button("−", () => zoom(1.4), { "aria-label": "zoom out" }),
    button("whole", reset),
  ];
}

function boundsOf(shapes) {
  const points = shapes.flatMap(({ curves, contacts }) => [
    ...curves.flatMap((curve) => [...curve.points, ...(curve.rest ?? [])]),
    ...contacts.map(({ x, y }) => [x, y]),
  ]);
  const [left, right] = extent(points.map(([x]) => x));
  const [bottom, top] = extent(points.map(([, y]) => y));
  const air = 0.08 * Math.max(right - left, top - bottom, 1e-9);
  return { x: left - air, y: -top - air, width: right - left + 2 * air, height: top - bottom + 2 * air };
}

/** 1, 2 or 5 of a power of ten, the nearest below. */
function roundLength(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  return power * [5, 2, 1].find((digit) => digit * power <= length);
}

/** In the plane; of all shapes, so that their arrows compare. */
function largestForce() {
  return Math.max(...report.shapes.flatMap(({ contacts }) => contacts.map(({ fx, fy }) => Math.hypot(fx, fy))), 0);
}

const pathOf = (points) => points.map(([x, y], index) => `${index ? "L" : "M"}${x} ${-y}`).join("");

function shapeDrawing(shape, colour, all) {
  const longest = 0.14 * Math.max(all.width, all.height);
  const curve = ({ name, kind, points, rest }) => [
    rest ? drawing("path", { class: "rest", d: pathOf(rest) }) : null,
    drawing(
      "path",
      { class: kind === "wire" ? "wire" : "vessel", d: pathOf(points), stroke: colour },
      drawing("title", {}, `${name} of ${shape.label}`),
    ),
  ];
  return drawing(
    "g",
    { "data-run": shape.run },
    shape.curves.flatMap(curve),
    shape.contacts.map((contact) => arrow(contact, longest, colour)),
  );
}

/** A force as an arrow whose tip is where it acts; the largest of all is `longest` mm long. */
function arrow({ x, y, fx, fy, force_N: force }, longest, colour) {
  const scale = longest / largestForce();
  const [dx, dy] = [fx * scale, -fy * scale];
  const length = Math.hypot(dx, dy);
  if (!(length > 0)) return null;
  const head = Math.min(0.35 * length, 0.09 * longest) / length;
  // From the tip back to either end of its head: a turn of the shaft by an arc tangent of 1/3.
  const barb = (side) => `${x - head * (dx - (side * dy) / 3)} ${-y - head * (dy + (side * dx) / 3)}`;
  const d = `M${x - dx} ${-y - dy}L${x} ${-y}M${barb(1)}L${x} ${-y}L${barb(-1)}`;
  return drawing("path", { class: "force", d, stroke: colour }, drawing("title", {}, `${numberText(force)} N`));
}
