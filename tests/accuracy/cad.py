"""Symmetric triangle meshes as in libraries of CAD models: furniture, vehicles, tools.

They are joined of closed pieces, which reach into each other, in random proportions. Each is its
own image in x = 0; tables, bottles and some others are so in further planes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .pieces import Mesh, box, joined, mirrored_in_x, plate, tube, wing

Rng = np.random.Generator
Pieces = list[Mesh]


def twins(mesh: Mesh) -> Pieces:
    return [mesh, mirrored_in_x(mesh)]


def rod(start: ArrayLike, end: ArrayLike, radius: ArrayLike, sides: int = 10) -> Mesh:
    """A straight tube; two radii make a cone."""
    return tube([start, end], radius, sides)


def turned_body(profile: ArrayLike, sides: int = 24) -> Mesh:
    """Around the z axis, from radii and heights (m, 2)."""
    radii, heights = np.asarray(profile, dtype=float).T
    return tube(np.column_stack([0 * heights, 0 * heights, heights]), radii, sides)


def bow(centre: ArrayLike, radius: float, start: float, end: float) -> NDArray[np.float64]:
    """Points of an arc in x = 0 about (y, z), from angle to angle in degrees."""
    angle = np.radians(np.linspace(start, end, 9))
    y, z = np.asarray(centre, dtype=float)
    return np.column_stack([0 * angle, y + radius * np.cos(angle), z + radius * np.sin(angle)])


def star(feet: int, reach: float, high: float, low: float, thick: float) -> Pieces:
    """An odd number of feet around the z axis, one of them in x = 0."""
    pieces: Pieces = []
    for k in range(feet // 2 + 1):
        angle = np.pi / 2 + 2 * np.pi * k / feet
        end = (reach * np.cos(angle) if k else 0, reach * np.sin(angle), low)
        foot = rod((0, 0, high), end, (thick, 0.6 * thick))
        pieces += twins(foot) if k else [foot]
    return pieces


def chair(rng: Rng) -> Pieces:
    width, depth, height = rng.uniform(0.35, 0.6, size=3)
    seat, leg, back = rng.uniform((0.015, 0.012, 0.3), (0.08, 0.03, 0.7))
    x, y, tilt = width / 2 - leg, depth / 2 - leg, rng.uniform(0, 0.15)
    pieces = [box((0, 0, height), (width, depth, seat))]
    if rng.random() < 0.25:
        pieces += [rod((0, 0, 0.1), (0, 0, height), leg), *star(5, x, 0.1, 0.02, leg)]
    else:
        splay, taper = 1 + rng.choice([0, rng.uniform(0, 0.2)]), rng.uniform(0.5, 1)
        for side in (-y, y):
            foot = (x * splay, side * splay, 0)
            pieces += twins(rod(foot, (x, side, height), (leg * taper, leg)))
    pieces += twins(rod((x, y, height), (x, y + tilt, height + back), leg))
    style = rng.choice(["panel", "slats", "bars"])
    if style == "panel":
        line = np.array([[y + 0.3 * tilt, height + 0.3 * back], [y + tilt, height + back]])
        pieces.append(plate(line - [leg / 2, 0], line + [leg / 2, 0], 2 * x))
    slats = np.linspace(0.35, 0.95, rng.integers(2, 6)) if style == "slats" else [0.95]
    for share in slats:
        centre = (0, y + tilt * share, height + back * share)
        pieces.append(box(centre, (2 * x, 0.8 * leg, 0.09 * back)))
    for share in np.linspace(0.2, 0.8, rng.integers(1, 4)) if style == "bars" else []:
        top = (x * share, y + tilt, height + back)
        pieces += twins(rod((x * share, y, height), top, leg / 3))
    if rng.random() < 0.4:
        arm = height + 0.4 * back
        pieces += twins(box((x + leg, leg, arm), (2.5 * leg, depth, leg)))
        pieces += twins(rod((x + leg, -y, height), (x + leg, -y, arm), leg / 2))
    return pieces


def table(rng: Rng) -> Pieces:
    width, depth, height = rng.uniform((0.5, 0.5, 0.3), (1.8, 1.0, 0.8))
    top, leg = rng.uniform((0.015, 0.015), (0.06, 0.05))
    if rng.random() < 0.3:
        radius = width / 2
        pieces = [turned_body([(radius, height), (radius, height + top)], 32)]
        pieces.append(rod((0, 0, 0.05), (0, 0, height), leg))
        return pieces + star(rng.choice([3, 5]), 0.7 * radius, 0.1, 0.01, leg)
    pieces = [box((0, 0, height), (width, depth, top))]
    inset = rng.uniform(1, 4) * leg
    x, y = width / 2 - inset, depth / 2 - inset
    for side in (-y, y):
        pieces += twins(rod((x, side, 0), (x, side, height), leg / 2, rng.choice([4, 12])))
    if rng.random() < 0.4:
        pieces.append(box((0, 0, rng.uniform(0.2, 0.6) * height), (2 * x, 2 * y, top)))
    if rng.random() < 0.4:
        drawers = rng.uniform(0.2, 0.8) * height
        pieces += twins(box((0.7 * x, 0, height - drawers / 2), (0.5 * x, 1.9 * y, drawers)))
    if rng.random() < 0.3:
        pieces.append(box((0, y, 0.75 * height), (2 * x, top, 0.5 * height)))
    return pieces


def lamp(rng: Rng) -> Pieces:
    base, height, pole, shade = rng.uniform((0.08, 0.4, 0.006, 0.08), (0.2, 1.6, 0.02, 0.25))
    slant, thick = rng.uniform(0.3, 1), rng.uniform(0.01, 0.05)
    style = rng.choice(["standing", "desk", "hanging"])
    pieces = [turned_body([(base, 0), (base, thick), (2 * pole, 2 * thick)])]
    if style == "standing":
        low = height - rng.uniform(0.8, 1.6) * shade
        pieces.append(rod((0, 0, 0), (0, 0, height), pole))
        return [*pieces, turned_body([(shade, low), (slant * shade, height)])]
    if style == "desk":
        elbow = np.array([0, rng.uniform(-0.4, -0.1), rng.uniform(0.5, 1)]) * height
        head = elbow + np.array([0, rng.uniform(0.3, 0.7), rng.uniform(-0.2, 0.3)]) * height
        down = np.array([0, rng.uniform(0, 0.8), -1])
        mouth = head + shade * down / np.linalg.norm(down)
        pieces += [rod((0, 0, 0), elbow, pole), rod(elbow, head, pole)]
        return [*pieces, rod(head, mouth, (0.3 * shade, 0.3 * shade / slant), 20)]
    arms = int(rng.choice([3, 5, 7]))
    pieces.append(rod((0, 0, 0), (0, 0, height / 2), pole))
    pieces += star(arms, 2 * shade, height / 2, 0.4 * height, pole)
    for k in range(arms // 2 + 1):
        angle = np.pi / 2 + 2 * np.pi * k / arms
        x, y = 2 * shade * np.array([np.cos(angle) if k else 0, np.sin(angle)])
        bulb = rod((x, y, 0.4 * height), (x, y, 0.4 * height - shade), (0.2 * shade, 0.5 * shade))
        pieces += twins(bulb) if k else [bulb]
    return pieces


def knife(rng: Rng) -> Pieces:
    blade, grip, width = rng.uniform((0.5, 0.3, 0.04), (0.8, 0.5, 0.15))
    thick, bend = rng.uniform(0.006, 0.02), rng.uniform(-0.6, 0.9)
    along = np.linspace(0, 1, 12)
    back = np.column_stack([blade * along, np.full(12, width / 2) - bend * width * along**3])
    edge = np.column_stack([blade * along, -width / 2 + (0.95 - bend) * width * along**4])
    pieces = [plate(back, edge, thick, edge=rng.uniform(0.1, 1))]
    half = rng.uniform(0.25, 0.5) * width
    handle = np.linspace(-grip, 0.02, 6)
    belly = half * (1 + rng.uniform(-0.3, 0.3) * np.sin(2 * np.pi * handle / grip))
    low = np.column_stack([handle, -belly + rng.uniform(-0.4, 0.1) * width * (handle / grip) ** 2])
    high = np.column_stack([handle, np.full(6, half)])
    pieces.append(plate(low, high, thick * rng.uniform(1.2, 3)))
    if rng.random() < 0.5:
        guard = rng.uniform(1, 2) * width
        pieces.append(box((0, 0, 0), (4 * thick, 2 * thick, guard)))
    for y in -grip * np.linspace(0.2, 0.8, 3) if rng.random() < 0.5 else []:
        pieces += twins(rod((0, y, 0), (2 * thick, y, 0), 0.25 * half))
    return pieces


def rifle(rng: Rng) -> Pieces:
    barrel, body, stock = rng.uniform((0.35, 0.2, 0.2), (0.6, 0.3, 0.35))
    bore, thick, high = rng.uniform((0.005, 0.02, 0.04), (0.014, 0.05, 0.07))
    pieces = [box((0, 0, 0), (thick, body, high))]
    front, rear, line = body / 2, -body / 2, 0.2 * high
    pieces.append(rod((0, front, line), (0, front + barrel, line), (bore, 0.8 * bore)))
    hand_guard = rng.uniform(0.2, 0.7) * barrel
    pieces.append(box((0, front + hand_guard / 2, line), (0.8 * thick, hand_guard, 0.6 * high)))
    drop = rng.uniform(0.3, 1.2) * high
    low = [[rear - stock, -high / 2 - 1.3 * drop], [rear, -high / 2]]
    top = [[rear - stock, high / 2 - drop], [rear, high / 2]]
    pieces.append(plate(low, top, 0.8 * thick))
    lean = rng.uniform(0.02, 0.06)
    grip = np.array([[rear + 0.02, 0], [rear + 0.02 - lean, -high / 2 - 0.1]])
    pieces.append(plate(grip, grip + [0.04, 0], 0.7 * thick))
    pieces.append(tube(bow((rear + 0.08, -high / 2), 0.03, 180, 360), 0.004, 6))
    if rng.random() < 0.7:
        lean, long = rng.uniform((0, 0.05), (0.05, 0.18))
        magazine = np.array([[0.2 * body, 0], [0.2 * body + lean, -high / 2 - long]])
        pieces.append(plate(magazine, magazine + [0.06, 0], 0.6 * thick))
    if rng.random() < 0.5:
        up, scope = high / 2 + 0.025, rng.uniform(0.06, 0.12)
        ends = np.array([[0, -scope, up], [0, -scope / 2, up], [0, scope / 2, up], [0, scope, up]])
        pieces += [tube(ends, np.array([0.016, 0.01, 0.01, 0.02]), 14)]
        for y in (-0.4 * scope, 0.4 * scope):
            pieces.append(box((0, y, up - 0.012), (0.01, 0.015, 0.03)))
    pieces.append(box((0, front + 0.97 * barrel, line + 2 * bore), (0.3 * bore, 0.01, 3 * bore)))
    if rng.random() < 0.25:
        hinge = (0, front + 0.7 * barrel, line)
        foot = (0.06, front + 0.72 * barrel, line - 0.18)
        pieces += twins(rod(hinge, foot, 0.004, 6))
    return pieces


def aircraft(rng: Rng) -> Pieces:
    radius, span, sweep = rng.uniform((0.03, 0.25, -0.02), (0.08, 0.65, 0.35))
    chord, taper, dihedral = rng.uniform((0.08, 0.2, -0.05), (0.25, 0.9, 0.12))
    y = np.array([-0.5, -0.47, -0.4, 0.0, 0.15, 0.5])
    fullness = np.array([0.05, 0.5, 1, 1, 0.9, rng.uniform(0.1, 0.3)])
    centre = np.column_stack([0 * y, y, radius * np.clip(y, 0, 1)])
    pieces = [tube(centre, radius * fullness, 20)]
    start, thick = rng.uniform(-0.25, -0.05), rng.uniform(0.06, 0.15)
    height = rng.uniform(-0.7, 0.8) * radius

    def surface(reach: float, front: float, deep: float, z: float) -> Mesh:
        end = taper * deep
        tip = (reach, front + sweep * reach, end, z + dihedral * reach, thick * end)
        return wing([(0, front, deep, z, thick * deep), tip])

    pieces += twins(surface(span, start, chord, height))
    tail = rng.uniform(0.3, 0.45)
    on_fin = rng.choice([0.2, 1.0]) * 2.5 * radius
    pieces += twins(surface(tail * span, 0.5 - 0.5 * chord, 0.45 * chord, on_fin))
    fin = np.array([[0.5 - 0.7 * chord, 0], [0.5 - 0.3 * chord, 2.6 * radius + 0.02]])
    pieces.append(plate(fin, fin + [[0.7 * chord, 0], [0.35 * chord, 0]], 0.05 * chord))
    if rng.random() < 0.6:
        for share in np.linspace(0.3, 0.6, rng.integers(1, 3)):
            x, front = share * span, start + sweep * share * span
            z = height + dihedral * x - 0.3 * radius
            nacelle = tube([(x, front - 0.05, z), (x, front, z), (x, front + 0.09, z)],
                           radius * np.array([0.3, 0.4, 0.25]))  # fmt: skip
            pieces += twins(nacelle)
    if rng.random() < 0.2:
        pieces += twins(surface(span, start, chord, height + 3 * radius))
        strut = (0.6 * span, start + sweep * 0.6 * span + 0.4 * chord, height)
        pieces += twins(rod(strut, np.add(strut, (0, 0, 3 * radius)), 0.005, 6))
    return pieces


def bottle(rng: Rng) -> Pieces:
    width, shoulder, neck, mouth = rng.uniform((0.1, 0.4, 0.55, 0.02), (0.35, 0.75, 0.95, 0.08))
    neck = max(neck, shoulder + 0.05)
    waist = rng.uniform(0.7, 1.1)
    profile = [(0.9 * width, 0), (width, 0.03), (waist * width, shoulder / 2), (width, shoulder),
               (mouth, neck), (mouth, 1)]  # fmt: skip
    body, faces = turned_body(profile)
    flat = rng.choice([1.0, rng.uniform(0.3, 0.8)])
    pieces = [(body * [1, flat, 1], faces)]
    if rng.random() < 0.6:
        pieces.append(turned_body([(1.3 * mouth, 0.95), (1.3 * mouth, rng.uniform(1, 1.1))]))
    if rng.random() < 0.4:
        reach = rng.uniform(0.5, 1) * shoulder / 2
        handle = bow((0.9 * flat * waist * width, shoulder / 2), reach, -80, 80)
        pieces.append(tube(handle, rng.uniform(0.01, 0.03), 8))
    if rng.random() < 0.2:
        tip = (0, -flat * width - rng.uniform(0.1, 0.3), shoulder + 0.1)
        pieces.append(rod((0, -0.8 * flat * width, 0.4 * shoulder), tip, (0.05, 0.02)))
    return pieces


def tool(rng: Rng) -> Pieces:
    """A hammer, screwdriver, wrench, saw or pair of pliers."""
    thick, grip = rng.uniform((0.01, 0.012), (0.03, 0.03))
    style = rng.choice(["hammer", "screwdriver", "wrench", "saw", "pliers"])
    if style == "hammer":
        head = rng.uniform(0.1, 0.3)
        claw = np.column_stack([np.linspace(0, head, 8), -0.5 * head * np.linspace(0, 1, 8) ** 2])
        pieces = [rod((0, 0, -0.9), (0, 0, 0.02), (1.2 * grip, grip))]
        pieces.append(rod((0, -head, 0), (0, 0.3 * head, 0), 1.5 * thick, 12))
        if rng.random() < 0.5:
            return [*pieces, plate(claw - [0, thick], claw + [0, thick], 2 * thick)]
        return [*pieces, plate(claw[[0, -1]] * [1, 0], claw[[0, -1]] * [1, 0] + [0, thick], thick)]
    if style == "screwdriver":
        long, blade = rng.uniform(0.3, 0.7), 0.3 * grip
        handle = [(grip, -0.35), (1.3 * grip, -0.2), (0.8 * grip, 0), (grip, 0.02)]
        tip = box((0, 0, long), (4 * blade, 0.8 * blade, 0.06))
        return [turned_body(handle, 12), rod((0, 0, 0), (0, 0, long), blade), tip]
    if style == "wrench":
        angle = np.linspace(0.2 * np.pi, 1.8 * np.pi, 14) + rng.uniform(-0.3, 0.3)
        ring = np.column_stack([np.cos(angle), np.sin(angle)]) * rng.uniform(0.06, 0.12)
        jaw = plate(0.5 * ring + [1, 0], ring + [1, 0], 1.5 * thick)
        shaft = np.array([[0, -0.7 * grip], [0.95, -grip]])
        eye = rod((-thick, 0, 0), (thick, 0, 0), 3 * grip)
        return [jaw, eye, plate(shaft, shaft * [1, -1], thick)]
    if style == "saw":
        y, deep = np.linspace(0, 0.7, 29), rng.uniform(0.06, 0.15)
        teeth = np.column_stack([y, -deep * (1 - 0.5 * y) + 0.015 * (np.arange(29) % 2)])
        back = np.column_stack([y, np.full(29, 0.0)])
        loop = bow((-0.08, -0.4 * deep), 0.07, 0, 360)
        return [plate(teeth, back, 0.3 * thick), tube(loop, 0.9 * thick, 8)]
    spread, long = rng.uniform((0.02, 0.1), (0.08, 0.35))
    handle = tube([(spread, -0.6, 0), (1.2 * spread, -0.3, 0), (0, 0, 0)], (grip, grip, 0.8 * grip))
    nose = rod((0.5 * thick, -0.02, 0), (0.3 * thick, long, 0), (2 * thick, thick))
    return [*twins(handle), *twins(nose), box((0, 0, 0), (3 * thick, 4 * thick, 3 * grip))]


KINDS: dict[str, Callable[[Rng], Pieces]] = {
    "chair": chair, "table": table, "lamp": lamp, "knife": knife, "rifle": rifle,
    "aircraft": aircraft, "bottle": bottle, "tool": tool,
}  # fmt: skip


def cad_mesh(kind: str, rng: Rng) -> Mesh:
    """One of the KINDS; x = 0 is a plane of symmetry."""
    return joined(KINDS[kind](rng))
