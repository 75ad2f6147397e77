// What things look like. A formulation has one colour, marker and dash pattern everywhere.

// Okabe and Ito's palette, which colour-blind readers tell apart; its yellow and black are replaced by what is seen on
// either ground.
const seriesColours = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a7a00", "#5b5b5b"],
  dark: ["#4aa8e8", "#f07d2b", "#1fc598", "#e29ac4", "#f0b429", "#9bd6f7", "#f0e442", "#b8b8b8"],
};
// Of Paul Tol's light scheme: not to be taken for formulations.
const termColours = ["#77aadd", "#ee8866", "#eedd88", "#ffaabb", "#99ddff", "#44bb99", "#bbcc33", "#aaaa00", "#dddddd"];
const markers = ["circle", "rect", "triangle", "rectRot", "star", "cross", "rectRounded"];
const dashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
const statusColours = {
  converged: "#009e73",
  invalid: "#e69f00",
  stalled: "#cc79a7",
  infeasible: "#d55e00",
  diverged: "#b3446c",
  failed: "#c0392b",
  refused: "#888888",
};

const schemes = ["automatic", "light", "dark"];
const darkPreferred = matchMedia("(prefers-color-scheme: dark)");
let scheme = "automatic";

const isDark = () => scheme === "dark" || (scheme === "automatic" && darkPreferred.matches);

function setScheme(chosen) {
  scheme = chosen;
  document.documentElement.dataset.scheme = isDark() ? "dark" : "light";
  redraw();
}
darkPreferred.addEventListener("change", () => setScheme(scheme));

/** The value of a colour of page.css, for what is drawn on a canvas. */
const pageColour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** Of a formulation: its family's, where lines are many, in a shade of its own. */
function lineStyle(line) {
  if (line < 0) return { colour: pageColour("muted"), marker: "circle", dash: [] };
  const family = familyOfLine[line];
  const members = families[family].lines;
  const pale = members.length > 1 ? 0.55 * (1 - members.indexOf(line) / (members.length - 1)) : 0;
  const style = styleOf(family);
  return { ...style, colour: hexadecimal(between(channels(style.colour), channels(pageColour("ground")), pale)) };
}

/** Of the so-manieth of several things. */
function styleOf(index) {
  const colours = seriesColours[isDark() ? "dark" : "light"];
  return {
    colour: colours[index % colours.length],
    marker: markers[index % markers.length],
    dash: dashes[Math.floor(index / colours.length) % dashes.length],
  };
}

const statusColour = (status) => statusColours[status] ?? "#c0392b";

const channels = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
/** A share of the way from one colour to another, all as [red, green, blue]. */
const between = (from, to, share) => from.map((part, index) => Math.round(part + share * (to[index] - part)));

// Of cividis, which reads the same to every eye.
const scaleStops = [
  "#00224e",
  "#123570",
  "#3b496c",
  "#575d6d",
  "#707173",
  "#8a8678",
  "#a59c74",
  "#c3b369",
  "#e1cc55",
  "#fee838",
].map(channels);

/** The colour of a share from 0 to 1, as [red, green, blue]. */
function scaleColour(share) {
  const at = Math.min(Math.max(share, 0), 1) * (scaleStops.length - 1);
  const below = Math.min(Math.floor(at), scaleStops.length - 2);
  return between(scaleStops[below], scaleStops[below + 1], at - below);
}
const hexadecimal = (colour) => `#${colour.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
const css = ([red, green, blue]) => `rgb(${red}, ${green}, ${blue})`;
const inkOn = ([red, green, blue]) => (0.299 * red + 0.587 * green + 0.114 * blue > 140 ? "#111" : "#fff");

/** A formulation's line and marker, for a legend or a table. */
function swatch(line) {
  const { colour, marker, dash } = lineStyle(line);
  return drawing(
    "svg",
    { class: "swatch", viewBox: "0 0 30 14", "aria-hidden": "true" },
    drawing("line", {
      x1: 0,
      x2: 30,
      y1: 7,
      y2: 7,
      stroke: colour,
      "stroke-width": 2,
      "stroke-dasharray": recommended.has(line) ? "" : dash.join(" "), // as it is drawn
    }),
    markerShape(marker, colour),
  );
}

function markerShape(marker, colour) {
  const paths = {
    circle: "M11 7a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
    rect: "M11 3h8v8h-8z",
    rectRounded: "M13 3h4l2 2v4l-2 2h-4l-2 -2v-4z",
    triangle: "M15 2.5l5 8.5h-10z",
    rectRot: "M15 2l5 5l-5 5l-5 -5z",
  };
  if (paths[marker]) return drawing("path", { d: paths[marker], fill: colour });
  const strokes = { star: "M15 2v10M10 7h10M11.5 3.5l7 7M18.5 3.5l-7 7", cross: "M15 2v10M10 7h10" };
  return drawing("path", { d: strokes[marker], stroke: colour, "stroke-width": 2 });
}
