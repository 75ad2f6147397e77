"""The scenes of the solver grids, as overrides of shipped compositions, and the choice of a part of them."""

import dataclasses
import hashlib
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLANAR = ROOT / "tests" / "grid" / "planar.toml"
HELICAL = ROOT / "scenes" / "helical-iliac-full.toml"
ARTERY = ROOT / "scenes" / "tortuous-iliac.toml"
ARTERY_POINTS = "vmr_0110/left_smoothed_200.csv"
ARTERY_ENDS = '[{ type = "clamped", tangent = [-0.492142416654365, 0.386515454003037, 0.78000105483674] }, "pinned"]'
DATA = "BOWSTRING_DATA"

GRID_A_NODES = (20, 40, 80, 160, 320, 640, 1280)
GRID_A_TENSIONS = (1, 2, 5, 10, 15, 20)
GRID_A_STIFFNESSES = (65, 500, 2000, 6132)
GRID_B_NODES = (200, 800)
GRID_B_TENSIONS = (2, 5, 10, 15)
GRID_B_STIFFNESSES = (4857, 1849, 291)
GRID_C_NODES = (80, 160, 320, 640, 1280)
GRID_C_NODES_FULL = (20, 40, 80, 160, 320, 640, 1280, 2560, 5120, 10240, 20000)
GRID_W_NODES = (80, 320, 1280)
LOAD_CHANGE = 1.05

AXES = ("anatomy", "kinematics", "vessel", "contact", "start", "nodes", "wire_bending_N_mm2", "tension_N")


@dataclasses.dataclass(frozen=True)
class Scene:
    """One composition with overrides (path, TOML value). `axes` follows AXES; `after`: the scene whose result a warm
    start is taken from; `skip`: why it cannot run here, or empty."""

    grid: str
    name: str
    axes: tuple
    file: pathlib.Path
    overrides: tuple
    after: str = ""
    skip: str = ""

    @property
    def nodes(self):
        return dict(zip(AXES, self.axes))["nodes"]


def make(grid, anatomy, nodes, bending, tension, kinematics="edge-frames", vessel="full", contact="node-wise",
         start="cold", after=""):
    """Tensions in N, bending stiffnesses in N mm^2. `vessel` is "full" or "bending" (no stretch, no torsion)."""
    overrides = [("vessel.iliac.kinematics", kinematics), ("wire.lunderquist.kinematics", kinematics),
                 ("constraint.lumen.type", f"{contact}-contact"),
                 ("energy.wire-bending.bending-stiffness", f"{bending} N mm^2"),
                 ("energy.axial-tension.tension", f"{tension:.17g} N")]
    if vessel == "bending":
        overrides += [("energy.vessel-strain.stretch-stiffness", "0 N"),
                      ("energy.vessel-strain.torsional-stiffness", "0 N mm^2")]
    skip = ""
    if anatomy == "artery":
        file = ARTERY
        folder = os.environ.get(DATA, "")
        skip = "" if folder else f"{DATA} is not set"
        points = pathlib.Path(folder).resolve() / ARTERY_POINTS
        # The file has 200 points, uniform in arc length.
        mesh = "" if nodes == 200 else f", nodes = {nodes}"
        overrides += [("vessel.iliac.geometry", f'{{ type = "csv", file = "{points}"{mesh} }}'),
                      ("vessel.iliac.radius", '{ column = "radius_mm" }'), ("wire.lunderquist.ends", ARTERY_ENDS)]
    else:
        file = {"planar": PLANAR, "helical": HELICAL}[anatomy]
        overrides.append(("vessel.iliac.geometry.nodes", str(nodes)))
    axes = (anatomy, kinematics, vessel, contact, start, nodes, bending, tension)
    name = f"{grid}-{anatomy}-{kinematics}-{vessel}-{contact}-{start}-N{nodes}-EI{bending}-T{tension:g}"
    return Scene(grid, name, axes, file, tuple(overrides), after, skip)


def grid_a(full=False):
    """Load, stiffness, mesh and contact formulation of two smooth anatomies: 672 scenes, cold."""
    return [make("A", anatomy, nodes, bending, tension, contact=contact)
            for anatomy in ("planar", "helical") for contact in ("node-wise", "segment-wise")
            for nodes in GRID_A_NODES for tension in GRID_A_TENSIONS for bending in GRID_A_STIFFNESSES]


def grid_b(full=False):
    """A real artery, soft to stiff wires on two meshes: 24 scenes, cold."""
    return [make("B", "artery", nodes, bending, tension)
            for nodes in GRID_B_NODES for bending in GRID_B_STIFFNESSES for tension in GRID_B_TENSIONS]


def grid_c(full=False):
    """Iterations against the mesh, by kinematics, and for a vessel that only bends."""
    return [make("C", anatomy, nodes, 65, 10, kinematics=kinematics, vessel=vessel)
            for anatomy in ("planar", "helical")
            for kinematics, vessel in (("edge-frames", "full"), ("nodes", "full"), ("edge-frames", "bending"))
            for nodes in (GRID_C_NODES_FULL if full else GRID_C_NODES)]


def grid_w(full=False):
    """A load changed by 5 %, from the solution before the change and, to compare with, cold."""
    scenes = []
    choices = [("planar", nodes, 65, 10) for nodes in GRID_W_NODES]
    choices += [("helical", nodes, 65, 10) for nodes in GRID_W_NODES]
    choices += [("helical", 320, 6132, 10), ("planar", 320, 6132, 10)]
    choices += [("artery", 200, 4857, 10), ("artery", 200, 291, 5)]
    for anatomy, nodes, bending, tension in choices:
        first = make("W", anatomy, nodes, bending, tension, start="first")
        changed = tension * LOAD_CHANGE
        scenes += [first, make("W", anatomy, nodes, bending, changed),
                   make("W", anatomy, nodes, bending, changed, start="warm", after=first.name)]
    return scenes


GRIDS = {"A": grid_a, "B": grid_b, "C": grid_c, "W": grid_w}


def shuffled(scenes):
    """An order without pattern that depends on nothing but the names, so that every K-th scene meets all axes."""
    return sorted(scenes, key=lambda scene: hashlib.sha256(scene.name.encode()).digest())


def select(scenes, every=1, nodes=None, match=""):
    """Every `every`-th of those with a number of nodes in `nodes` and `match` in their name; what a warm start needs
    comes along. Scenes without `after` stand first."""
    by_name = {scene.name: scene for scene in scenes}
    kept = [scene for scene in shuffled(scenes) if (not nodes or scene.nodes in nodes) and match in scene.name]
    chosen = {scene.name: scene for scene in kept[::every]}
    for scene in list(chosen.values()):
        if scene.after:
            chosen.setdefault(scene.after, by_name[scene.after])
    return sorted(chosen.values(), key=lambda scene: bool(scene.after))
