"""Scene number k of a seed, as a composition. Every number is drawn from a range that stands in README.md."""

import dataclasses
import math
import random

import curves
from curves import drawn, quantity

AXES = ("group", "dimension", "shape", "kinematics", "contact", "gap", "length", "span", "lumen", "vessel_nodes",
        "wire_nodes", "nodes", "wire_bending_N_mm2", "vessel_bending_N_mm2", "stretch_N", "anchoring_N_per_mm2",
        "tension_N", "clearance_mm", "vessel_length_mm", "tortuosity", "tube_curvature", "wire_ends", "vessel_ends",
        "load", "rows")

GROUPS = ("posed", "unposed")
UNPOSED = ("no-stretch", "no-torsion", "push", "no-foundation", "no-clearance")

LENGTH = (60.0, 500.0)
LUMEN = (3.0, 12.0)
WIRE_RADIUS = (0.2, 1.0)
NODES = (12, 640)
MESH_RATIO = (1.0 / 3.0, 3.0)
FEWEST_WIRE_NODES = 8
VESSEL_TURN = 0.5    # rad between neighbouring edges of State 1
WIRE_TURN = 0.6
WIRE_EDGE = 2.0      # of the smallest clearance: a longer chord does not see the bends that it is in
TUBE_CURVATURE = 0.75
TORTUOSITY = 2.5     # length over chord: a tension that pulls a wire straight shortens its vessel by as much
RADIUS_SLOPE = 0.3
REGULARITY = 0.2     # 1 − Rκ − R'² − RR'' at every node: the wall has a normal there
ROOM_BETWEEN_LIMBS = 1.0
WIRE_BENDING = (10.0, 6000.0)
VESSEL_BENDING = (20.0, 1000.0)
TUBE_FACTOR = (0.3, 3.0)
ANCHORING = (0.003, 0.05)
TENSION = 30.0
ROWS_APART = 0.65    # of the clearance, as rows-per-segment = "auto" keeps them
END_MOVE = 0.3       # of the smallest clearance
END_TURN = math.radians(10.0)
ROLLER_TISSUE = 100.0  # mm²: times the foundation's modulus, the tension that an end on a roller may bear
CONTINUED_FROM = 0.05
CONTINUED_PARTS = (4, 8)  # of a segment, each with a row of its own


class Stream:
    """Numbers from one stream; only random() is used, whose values no version of Python changes."""

    def __init__(self, seed, number, group):
        self.random = random.Random(f"bowstring {group} {seed} {number}").random

    def uniform(self, low, high):
        return drawn(low + (high - low) * self.random())

    def logarithmic(self, low, high):
        return drawn(math.exp(math.log(low) + (math.log(high) - math.log(low)) * self.random()))

    def chance(self, share):
        return self.random() < share

    def sign(self):
        return 1.0 if self.random() < 0.5 else -1.0

    def pick(self, shares):
        """A key of {key: share}; shares sum to 1."""
        left = self.random()
        for key, share in shares.items():
            left -= share
            if left < 0.0:
                return key
        return list(shares)[-1]


@dataclasses.dataclass(frozen=True)
class Drawn:
    """A scene: its composition as text, and its place on every axis of AXES."""

    name: str
    text: str
    axes: dict


# --- geometry -------------------------------------------------------------------------------------------------------


def draw_shape(stream, dimension):
    kinds = {"line": 0.08, "arc": 0.17, "sinusoid": 0.25, "helix": 0.2, "arcs": 0.3}
    if dimension == 2:
        kinds = {"line": 0.08, "arc": 0.25, "sinusoid": 0.34, "arcs": 0.33}
    kind = stream.pick(kinds)
    if kind == "line":
        return curves.line(stream.uniform(*LENGTH))
    if kind == "arc":
        angle = stream.sign() * stream.uniform(0.15, 3.6)
        return curves.arc(drawn(stream.uniform(*LENGTH) / abs(angle)), angle)
    if kind == "sinusoid":
        chord = stream.uniform(50.0, 450.0)
        return curves.sinusoid(chord, stream.sign() * drawn(chord * stream.uniform(0.02, 0.3)), stream.uniform(0.4, 3.0))
    if kind == "helix":
        return curves.helix(stream.uniform(50.0, 450.0), stream.uniform(3.0, 40.0),
                            stream.sign() * stream.uniform(0.3, 3.0))
    segments = []
    for _ in range(int(2 + 6 * stream.random())):
        plane = stream.uniform(-math.pi, math.pi) if dimension == 3 else 0.0
        bend = stream.uniform(0.0, 1.4) * (stream.sign() if dimension == 2 else 1.0)
        segments.append((stream.uniform(15.0, 90.0), bend, plane))
    return curves.arcs(segments)


class Lumen:
    """A radius along the vessel: constant, or a table on at most 160 places, linear between."""

    def __init__(self, length, mean, swing=0.0, wave=1.0, phase=0.0):
        self.mean, self.swing = mean, swing
        self.places, self.values = [0.0], [mean]
        if swing:
            count = 160
            self.places = [drawn(length * i / (count - 1)) for i in range(count)]
            self.values = [drawn(mean + swing * math.cos(2.0 * math.pi * s / wave + phase)) for s in self.places]

    def __call__(self, s):
        if not self.swing:
            return self.mean
        at = min(max(s / self.places[-1], 0.0), 1.0) * (len(self.places) - 1)
        i = min(int(at), len(self.places) - 2)
        return self.values[i] + (at - i) * (self.values[i + 1] - self.values[i])

    @property
    def smallest(self):
        return min(self.values)

    @property
    def largest(self):
        return max(self.values)

    @property
    def steepest(self):
        return max((abs(b - a) / (t - s) for a, b, s, t in
                    zip(self.values, self.values[1:], self.places, self.places[1:])), default=0.0)

    def toml(self):
        if not self.swing:
            return text_of(quantity(self.mean, "mm"))
        return text_of({"table": [[quantity(s, "mm"), quantity(r, "mm")] for s, r in zip(self.places, self.values)]})


def draw_lumen(stream, length):
    mean = stream.uniform(*LUMEN)
    if not stream.chance(0.3):
        return Lumen(length, mean)
    swing = drawn(stream.uniform(0.05, 0.4) * mean)
    return Lumen(length, mean, swing, stream.uniform(0.3, 2.0) * length, stream.uniform(0.0, 2.0 * math.pi))


def regular(shape, lumen, nodes):
    """Whether a radius that varies leaves the wall a normal, at the vessel's nodes, where its spline has its values."""
    if not lumen.swing:
        return True
    h = shape.length / (nodes - 1)
    for i in range(1, nodes - 1):
        before, here, after = (lumen((i + j) * h) for j in (-1, 0, 1))
        kappa = shape.curvature[min(round(i / (nodes - 1) * (len(shape.s) - 1)), len(shape.s) - 1)]
        slope, bend = 0.5 * (after - before) / h, (after - 2.0 * here + before) / (h * h)
        if 1.0 - here * kappa - slope * slope - here * bend < REGULARITY:
            return False
    return True


def draw_tube(stream, dimension):
    """A vessel that a composition would take: (shape, lumen, wire radius). Redrawn as a whole until it is."""
    while True:
        shape = draw_shape(stream, dimension)
        if not LENGTH[0] <= shape.length <= LENGTH[1]:
            continue
        lumen = draw_lumen(stream, shape.length)
        wire_radius = stream.uniform(*WIRE_RADIUS)
        if lumen.smallest < LUMEN[0] or lumen.largest > LUMEN[1] or lumen.steepest > RADIUS_SLOPE:
            continue
        if curves.tube_curvature(shape, lumen) >= TUBE_CURVATURE or shape.length > TORTUOSITY * shape.chord:
            continue
        if curves.limbs_apart(shape, lumen, ROOM_BETWEEN_LIMBS):
            return shape, lumen, wire_radius


def draw_meshes(stream, shape, lumen, span, same, clearance):
    """Nodes of vessel and wire. Bends are resolved: edges of State 1 turn by at most VESSEL_TURN and WIRE_TURN, and no
    chord is longer than WIRE_EDGE clearances."""
    sharpest = max(shape.curvature)
    fewest = max(NODES[0], math.ceil(1.0 + sharpest * shape.length / VESSEL_TURN))
    while True:
        vessel = round(stream.logarithmic(min(fewest, NODES[1]), NODES[1]))
        if not regular(shape, lumen, vessel):
            continue
        ratio = 1.0 if same else stream.logarithmic(*MESH_RATIO)
        wire = round((vessel - 1) * span / shape.length * ratio) + 1
        edge = span / (wire - 1) if wire > 1 else span
        if wire >= FEWEST_WIRE_NODES and sharpest * edge <= WIRE_TURN and edge <= WIRE_EDGE * clearance:
            return vessel, wire


# --- ends and loads -------------------------------------------------------------------------------------------------


def small_move(stream, dimension, reach):
    """A vector whose length is at most `reach`."""
    return [quantity(stream.uniform(-1.0, 1.0) * reach / math.sqrt(dimension), "mm") for _ in range(dimension)]


def small_turn(stream, dimension):
    """About an axis across the end's tangent, which is the first of its axes."""
    if dimension == 2:
        return quantity(stream.uniform(-END_TURN, END_TURN), "rad")
    return [quantity(0.0, "rad")] + [quantity(stream.uniform(-END_TURN, END_TURN) / math.sqrt(2.0), "rad")
                                     for _ in range(2)]


def draw_wire_end(stream, dimension, reach, roller):
    """(label, value). `reach`: how far an end may be moved, mm; `roller`: whether it may move across its direction."""
    label = stream.pick({"pinned": 0.33, "clamped": 0.3, "pinned-moved": 0.1, "clamped-moved": 0.1, "clamped-turned": 0.1,
                         "roller": 0.07})
    if label == "roller" and not roller:
        label = "pinned"
    if label in ("pinned", "clamped"):
        return label, label
    table = {"type": label.partition("-")[0]}
    if label == "roller":
        return label, {"position": ["held"] + ["free"] * (dimension - 1), "axes": "end"}
    if label == "clamped-turned":
        table.update(axes="end", turn=small_turn(stream, dimension))
    else:
        table.update(move=small_move(stream, dimension, reach))
    return label, table


def draw_vessel_end(stream, dimension, reach):
    label = stream.pick({"pinned": 0.6, "clamped": 0.3, "pinned-moved": 0.1})
    if label != "pinned-moved":
        return label, label
    return label, {"type": "pinned", "move": small_move(stream, dimension, reach)}


def draw_force(stream, dimension, largest):
    direction = [stream.uniform(-1.0, 1.0) for _ in range(dimension)]
    size = math.hypot(*direction) or 1.0
    force = largest * stream.random()
    return [quantity(force * value / size, "N") for value in direction]


# --- compositions ---------------------------------------------------------------------------------------------------


def text_of(value):
    """A value as TOML on one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {text_of(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(text_of(entry) for entry in value) + "]"
    if isinstance(value, str):
        return f'"{value}"'
    return f"{value!r}"


def table(header, entries):
    return "\n".join([header, *(f"{key} = {value if raw else text_of(value)}" for key, value, *raw in entries), ""])


def draw_tension(stream):
    way = stream.pick({"none": 0.1, "logarithmic": 0.45, "uniform": 0.45})
    if way == "none":
        return 0.0
    return stream.logarithmic(0.05, TENSION) if way == "logarithmic" else stream.uniform(0.0, TENSION)


def draw(seed, number, group="posed", continuation=False):
    """Scene `number` of a seed; the same arguments give the same text."""
    stream = Stream(seed, number, group)
    flaw = UNPOSED[number % len(UNPOSED)] if group == "unposed" else None
    dimension = 3 if flaw == "no-torsion" or stream.chance(0.6) else 2
    shape, lumen, wire_radius = draw_tube(stream, dimension)
    clearance = lumen.smallest - wire_radius
    geometry = dict(shape.geometry)
    if stream.chance(0.3):
        geometry["origin"] = [quantity(stream.uniform(-100.0, 100.0), "mm") for _ in range(dimension)]
        geometry["rotation"] = [quantity(stream.uniform(-1.8, 1.8), "rad") for _ in range(1 if dimension == 2 else 3)]

    contact = stream.pick({"node-wise": 0.5, "segment-wise": 0.3, "same-index": 0.2})
    partly = contact != "same-index" and flaw != "push" and stream.chance(0.25)
    span = shape.length if not partly else drawn(shape.length * stream.uniform(0.35, 0.9))
    free_tip = flaw != "push" and stream.chance(0.7 if partly else 0.15)
    vessel_nodes, wire_nodes = draw_meshes(stream, shape, lumen, span, contact == "same-index", clearance)

    way = stream.pick({"edge-frames": 0.6, "nodes": 0.25, "wire-nodes": 0.075, "vessel-nodes": 0.075})
    kinematics = {"edge-frames": ("edge-frames", "edge-frames"), "nodes": ("nodes", "nodes"),
                  "wire-nodes": ("nodes", "edge-frames"), "vessel-nodes": ("edge-frames", "nodes")}[way]
    gap = stream.pick({"squared": 0.8, "smooth-distance": 0.2})
    rows = "auto" if contact != "segment-wise" and span / (wire_nodes - 1) > ROWS_APART * clearance else 1

    wire_bending = stream.logarithmic(*WIRE_BENDING)
    vessel_bending = stream.logarithmic(*VESSEL_BENDING)
    torsion = drawn(vessel_bending * 2.0 / 3.0 * stream.logarithmic(*TUBE_FACTOR))
    stretch = drawn(2.0 * vessel_bending / lumen.mean ** 2 * stream.logarithmic(*TUBE_FACTOR))
    anchoring = stream.logarithmic(*ANCHORING)
    tension = draw_tension(stream)

    roller = not free_tip and tension <= anchoring * ROLLER_TISSUE
    first_label, first = draw_wire_end(stream, dimension, END_MOVE * clearance, roller)
    if free_tip and first_label in ("pinned", "roller", "pinned-moved"):
        first_label, first = "clamped", "clamped"
    last_label, last = ("free", "free") if free_tip else draw_wire_end(stream, dimension, END_MOVE * clearance, roller)
    # A start takes a turn along to an end that is free to follow, and so leaves the lumen.
    if first_label == "clamped-turned" and last_label in ("free", "roller"):
        first_label, first = "clamped", "clamped"
    if last_label == "clamped-turned" and first_label == "roller":
        last_label, last = "clamped", "clamped"
    vessel_first = draw_vessel_end(stream, dimension, END_MOVE * clearance)
    vessel_last = draw_vessel_end(stream, dimension, END_MOVE * clearance)

    coils = wire_bending / (2.0 * (lumen.largest - wire_radius) ** 2)
    # On a wire whose material slides only its ends are places, and those are held.
    load = stream.pick({"none": 0.5, "wire": 0.35, "vessel": 0.15} if free_tip else {"none": 0.75, "vessel": 0.25})
    place = drawn(stream.uniform(0.15, 0.85) * (span if load == "wire" else shape.length))
    if load == "wire" and stream.chance(0.5):
        place = "last"
    largest = {"none": 0.0, "vessel": min(0.5, 0.2 * stretch),
               "wire": min(0.5, 0.5 * coils)}[load]
    force = draw_force(stream, dimension, largest)
    push = stream.uniform(1.2, 5.0)

    radius_text = lumen.toml()
    if flaw == "no-stretch":
        stretch = 0.0
    elif flaw == "no-torsion":
        torsion = 0.0
    elif flaw == "push":
        tension = -drawn(push * wire_bending / (2.0 * clearance ** 2))
    elif flaw == "no-foundation":
        anchoring = 0.0
    elif flaw == "no-clearance":
        # From a wire that is thicker than the lumen to one with a hundredth of a millimetre of room.
        room = stream.pick({"none": 0.3, "negative": 0.2, "small": 0.5})
        wire_radius = drawn(lumen.smallest - {"none": 0.0, "negative": -0.2, "small": stream.uniform(1e-4, 1e-2)}[room])
        clearance = lumen.smallest - wire_radius
        rows = 1

    wire = [("name", "wire"), ("vessel", "vessel"), ("radius", quantity(wire_radius, "mm")), ("nodes", wire_nodes),
            ("ends", [first, last]), ("kinematics", kinematics[0])]
    if partly:
        wire.append(("span", ["0 mm", quantity(span, "mm")]))
    parts = [
        table(f'schema = 1\ntitle = "Random scene {number} of seed {seed}, {group}"\n\n[scene]',
              [("dimension", dimension)]),
        table("[[vessel]]", [("name", "vessel"), ("geometry", {**geometry, "nodes": vessel_nodes}),
                             ("radius", radius_text, True), ("ends", [vessel_first[1], vessel_last[1]]),
                             ("kinematics", kinematics[1])]),
        table("[[wire]]", wire),
        table("[[energy]]", [("type", "wire-bending"), ("on", "wire"),
                             ("bending-stiffness", quantity(wire_bending, "N mm^2"))]),
        table("[[energy]]", [("type", "vessel-strain"), ("on", "vessel"),
                             ("bending-stiffness", quantity(vessel_bending, "N mm^2")),
                             ("torsional-stiffness", quantity(torsion, "N mm^2")),
                             ("stretch-stiffness", quantity(stretch, "N"))])]
    if anchoring:
        parts.append(table("[[energy]]", [("type", "anchoring"), ("on", "vessel"),
                                          ("stiffness", quantity(anchoring, "N/mm^2"))]))
    if not free_tip:
        parts.append(table("[[energy]]", [("type", "axial-tension"), ("on", "wire"),
                                          ("tension", quantity(tension, "N"))]))
    if load != "none":
        at = place if place == "last" else quantity(place, "mm")
        parts.append(table("[[energy]]", [("type", "point-load"), ("on", load), ("force", force), ("at", at)]))
    constraint = [("name", "lumen"), ("type", f"{contact}-contact"), ("on", ["wire", "vessel"]), ("gap", gap)]
    if rows != 1:
        constraint.append(("rows-per-segment", rows))
    parts.append(table("[[constraint]]", constraint))
    parts.append(table("[solver]", [("type", "interior-point")]))
    if continuation and contact == "segment-wise":
        first, last = CONTINUED_PARTS
        parts.append(table("[continuation]", [("path", "constraint.lumen.rows-per-segment"), ("from", first), ("to", last),
                                              ("first-step", 1), ("when", "fallback")]))
    elif continuation and not free_tip and tension > CONTINUED_FROM:
        parts.append(table("[continuation]", [("path", "energy.axial-tension.tension"),
                                              ("from", quantity(CONTINUED_FROM, "N")), ("to", quantity(tension, "N")),
                                              ("when", "fallback")]))

    axes = dict(group=flaw or group, dimension=dimension, shape=shape.kind, kinematics=way, contact=contact, gap=gap,
                length="fixed" if free_tip else "sliding", span="part" if partly else "whole",
                lumen="table" if lumen.swing else "constant", vessel_nodes=vessel_nodes, wire_nodes=wire_nodes,
                nodes=max(vessel_nodes, wire_nodes), wire_bending_N_mm2=wire_bending, vessel_bending_N_mm2=vessel_bending,
                stretch_N=stretch, anchoring_N_per_mm2=anchoring, tension_N=0.0 if free_tip else tension,
                clearance_mm=drawn(clearance), vessel_length_mm=drawn(shape.length),
                tortuosity=drawn(shape.length / max(shape.chord, 1e-6)),
                tube_curvature=drawn(curves.tube_curvature(shape, lumen)), wire_ends=f"{first_label}/{last_label}",
                vessel_ends=f"{vessel_first[0]}/{vessel_last[0]}", load=load, rows=rows)
    return Drawn(f"{group}-{seed}-{number:04d}", "\n".join(parts), axes)
