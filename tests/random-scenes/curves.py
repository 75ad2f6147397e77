"""Vessels drawn at random: tables of a composition's geometry, and points along the curves that they describe, for the
checks that a tube must pass before a scene may use it. Lengths in mm, angles in rad."""

import dataclasses
import math

STEP = 1.0  # mm between the points of the checks, at most a two-hundredth of the curve


@dataclasses.dataclass(frozen=True)
class Shape:
    """`geometry`: keys of the composition's table, without `nodes`; `s`, `points` (always three numbers), `curvature`:
    samples, `s` ascending from 0 to the length."""

    kind: str
    geometry: dict
    s: list
    points: list
    curvature: list

    @property
    def length(self):
        return self.s[-1]

    @property
    def chord(self):
        return math.dist(self.points[0], self.points[-1])


def quantity(value, unit):
    """Six digits are what is drawn: what stands in the composition is the number itself."""
    return f"{value:.6g} {unit}"


def drawn(value):
    return float(f"{value:.6g}")


def parametric(kind, geometry, position, first, second, end):
    """Samples of a curve given by position and two derivatives over a parameter in [0, end]."""
    count = 2000
    t = [end * i / count for i in range(count + 1)]
    points = [position(value) for value in t]
    speed = [math.hypot(*first(value)) for value in t]
    s = [0.0]
    for i in range(count):
        middle = math.hypot(*first(0.5 * (t[i] + t[i + 1])))
        s.append(s[-1] + (speed[i] + 4.0 * middle + speed[i + 1]) / 6.0 * end / count)
    curvature = [math.hypot(*cross(first(value), second(value))) / rate ** 3 for value, rate in zip(t, speed)]
    every = max(1, int(count / max(200.0, s[-1] / STEP)))
    return Shape(kind, geometry, s[::every], points[::every], curvature[::every])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def line(length):
    return parametric("line", {"type": "line", "length": quantity(length, "mm")}, lambda x: (x, 0.0, 0.0),
                      lambda x: (1.0, 0.0, 0.0), lambda x: (0.0, 0.0, 0.0), length)


def arc(radius, angle):
    side = math.copysign(1.0, angle)
    return parametric(
        "arc", {"type": "arc", "radius": quantity(radius, "mm"), "angle": quantity(angle, "rad")},
        lambda a: (radius * math.sin(a), side * radius * (1.0 - math.cos(a)), 0.0),
        lambda a: (radius * math.cos(a), side * radius * math.sin(a), 0.0),
        lambda a: (-radius * math.sin(a), side * radius * math.cos(a), 0.0), abs(angle))


def sinusoid(chord, amplitude, periods):
    k = 2.0 * math.pi * periods / chord
    return parametric(
        "sinusoid", {"type": "sinusoid", "chord": quantity(chord, "mm"), "amplitude": quantity(amplitude, "mm"),
                     "periods": drawn(periods)},
        lambda x: (x, amplitude * math.sin(k * x), 0.0), lambda x: (1.0, amplitude * k * math.cos(k * x), 0.0),
        lambda x: (0.0, -amplitude * k * k * math.sin(k * x), 0.0), chord)


def helix(chord, radius, turns):
    k = 2.0 * math.pi * turns / chord
    return parametric(
        "helix", {"type": "helix", "chord": quantity(chord, "mm"), "radius": quantity(radius, "mm"),
                  "turns": drawn(turns)},
        lambda x: (x, radius * math.cos(k * x), radius * math.sin(k * x)),
        lambda x: (1.0, -radius * k * math.sin(k * x), radius * k * math.cos(k * x)),
        lambda x: (0.0, -radius * k * k * math.cos(k * x), -radius * k * k * math.sin(k * x)), chord)


def arcs(segments):
    """`segments`: (length, bend, plane). The curvature of one is bend/length (1 − cos 2πs/length), about a direction of
    the frame that is carried along without twist."""
    frame = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    s, points, curvature = [0.0], [(0.0, 0.0, 0.0)], [0.0]
    step = min(STEP, sum(length for length, _, _ in segments) / 200.0)
    for length, bend, plane in segments:
        count = max(8, math.ceil(length / step))
        ds = length / count
        for i in range(count):
            swept = (bend_until(length, bend, (i + 1) * ds) - bend_until(length, bend, i * ds))
            half = turned(frame, 0.5 * swept, plane)
            points.append(tuple(p + ds * t for p, t in zip(points[-1], half[0])))
            frame = turned(frame, swept, plane)
            s.append(s[-1] + ds)
            curvature.append(abs(bend / length * (1.0 - math.cos(2.0 * math.pi * (i + 1) / count))))
    table = [{"length": quantity(length, "mm"), "bend": quantity(bend, "rad"), "plane": quantity(plane, "rad")}
             for length, bend, plane in segments]
    return Shape("arcs", {"type": "arcs", "segments": table}, s, points, curvature)


def bend_until(length, bend, s):
    return bend * (s / length - math.sin(2.0 * math.pi * s / length) / (2.0 * math.pi))


def turned(frame, angle, plane):
    """The frame after its tangent has turned by `angle` toward cos(plane) e₂ + sin(plane) e₃, without twist."""
    tangent, second, third = frame
    toward = tuple(math.cos(plane) * a + math.sin(plane) * b for a, b in zip(second, third))
    axis = cross(tangent, toward)

    def rotate(vector):
        along = sum(a * b for a, b in zip(axis, vector))
        return tuple(v * math.cos(angle) + w * math.sin(angle) + a * along * (1.0 - math.cos(angle))
                     for v, w, a in zip(vector, cross(axis, vector), axis))

    return [rotate(vector) for vector in frame]


def tube_curvature(shape, radius):
    """Largest R κ; `radius` is a function of s."""
    return max(radius(s) * kappa for s, kappa in zip(shape.s, shape.curvature))


def limbs_apart(shape, radius, room):
    """Whether the vessel stays at least `room` outside of itself: no two places of it that are farther apart along it than
    half a circle of its own radius are nearer than their radii and `room`."""
    every = max(1, len(shape.s) // 200)
    s, points = shape.s[::every], shape.points[::every]
    radii = [radius(value) for value in s]
    for i, (place, p) in enumerate(zip(s, points)):
        for j in range(i + 1, len(s)):
            both = radii[i] + radii[j]
            if s[j] - place > 0.5 * math.pi * both + room and math.dist(p, points[j]) < both + room:
                return False
    return True
