"""What a score means: the same at every sampling, for uneven sides, and the share that is mirrored."""

from __future__ import annotations

import numpy as np

import symsurf
from symsurf import Plane

from .case import Case, Figures, at_least, at_most, timed_detect
from .damage import hole, noise
from .judged_shapes import SYMMETRIC, Cut, in_pose, matched, one_side_denser, symmetric
from .pieces import Mesh, tube
from .planes import difference
from .solids import sampled

Rng = np.random.Generator

SIZES = (1000, 3000, 10_000, 30_000, 100_000)
DENSITY_SIZES = (2000, 8000, 30_000)
COUNT = 8000
MIRRORED = ("ant", "airplane", "cow", "face", "CAD", "blob", "pot", "shell")
"""Bodies whose images are exact, and no face so near to another that it stands for it."""


def _drift(name: str, share: float) -> Case:
    """How far the score over the true mirror is from that of the most points."""

    def run(subject: str, rng: Rng) -> Figures:
        vertices, faces, plane = symmetric(subject, rng)
        scores = [
            matched(noise(sampled(vertices, faces, size, rng), share, rng), plane) for size in SIZES
        ]
        off = np.abs(np.subtract(scores, scores[-1]))
        return {"at 1000": off[0], "from 3000 on": off[1:].max(),
                **{f"score, {size}": score for size, score in zip(SIZES, scores)}}  # fmt: skip

    bars = {"at 1000": at_most(0.08), "from 3000 on": at_most(0.03)}
    return Case(f"judgement, drift of the score, {name}", SYMMETRIC, run, bars)


def _uneven(ratio: int, least: float) -> Case:
    def run(subject: str, rng: Rng) -> Figures:
        points, plane = one_side_denser(subject, ratio, int(rng.choice(DENSITY_SIZES)), rng)
        result, seconds = timed_detect(points, "auto")
        kind = result.mirror.kind if result.mirror else ""
        return {
            "true plane": matched(points, plane),
            "found plane": float(result.verdict == "found" and kind == "plane"),
            "kind plane": float(kind == "plane"),
            "score": result.score,
            "seconds": seconds,
        }

    bars = {"true plane": at_least(least), "found plane": at_least(0.98)}
    return Case(f"judgement, one side {ratio} times as dense", SYMMETRIC, run, bars)


SHARES = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)


def _cut(subject: str, rng: Rng) -> Figures:
    """Ever more of one side is lost: the score over the share that has a partner left."""
    vertices, faces, plane = symmetric(subject, rng)
    points = sampled(vertices, faces, COUNT, rng)
    cut = Cut(points, plane, rng)
    pieces = [cut.kept(share) for share in SHARES]
    scores = np.array([matched(points[left], plane) for left, _ in pieces])
    off = scores - [partnered for _, partnered in pieces]
    return {"off": np.abs(off).max(), "monotone": float((np.diff(scores) < 0).all()),
            **{f"off, {share:.0%} lost": value for share, value in zip(SHARES, off)}}  # fmt: skip


def _below(subject: str, rng: Rng) -> Figures:
    """The result's score over the true plane's where a piece is lost: an end of a side, or a hole."""
    vertices, faces, plane = symmetric(subject, rng)
    points = sampled(vertices, faces, COUNT // 2, rng)
    if rng.random() < 0.5:
        points = points[Cut(points, plane, rng).kept(rng.uniform(0.2, 0.5))[0]]
    else:
        points = points[hole(points, rng.uniform(0.1, 0.25), rng)]
    result, seconds = timed_detect(points, "auto")
    above = result.score - matched(points, plane)
    return {"above true": above, "never below": float(above >= -0.03), "score": result.score,
            "seconds": seconds}  # fmt: skip


def _prism(rng: Rng) -> Mesh:
    """A smooth outline at random corners and a smaller one, a thin face from each edge to the other
    outline, fans from the first corner; the sides share no vertices."""
    sides = int(rng.integers(80, 200))
    angle = 2 * np.pi * (np.arange(sides) + rng.uniform(0, 0.9, size=sides)) / sides
    # Cosines of the angle from the y axis are the same on both sides of x = 0.
    waves = np.cos((angle - np.pi / 2)[:, None] * np.arange(1, 5))
    radius = 1 + waves @ rng.uniform(-0.15, 0.15, size=4)
    outline = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    low = np.column_stack([outline, np.zeros(sides)])
    top = np.column_stack([rng.uniform(0.4, 0.8) * outline, np.full(sides, rng.uniform(0.5, 3))])
    k, after = np.arange(sides), np.roll(np.arange(sides), -1)
    walls = [
        np.column_stack([k, after, after + sides]),
        np.column_stack([k, after + sides, k + sides]),
    ]
    fan = np.column_stack([np.zeros(sides - 2, dtype=int), k[1:-1], k[2:]])
    return np.vstack([low, top]), np.vstack([*walls, fan, fan + sides])


def _can(rng: Rng) -> Mesh:
    """A bent tube of an odd number of long faces around, so that the sides share no vertices."""
    length, bend = rng.uniform(1.5, 5), rng.uniform(0.2, 0.6)
    path = [(0, 0, 0), (0, 0.3 * bend * length, 0.5 * length), (0, bend * length, length)]
    radii = np.append(1, rng.uniform(0.4, 0.9, size=2))
    return tube(path, radii, 2 * int(rng.integers(20, 50)) + 1)


def _cut_up(mesh: Mesh, rng: Rng, rounds: int = 2) -> Mesh:
    """The same surface, half of the faces split at a random point, twice."""
    vertices, faces = mesh
    for _ in range(rounds):
        split = rng.random(len(faces)) < 0.5
        a, b, c = faces[split].T
        weights = rng.dirichlet(np.ones(3), size=len(a))[:, :, None]
        new = len(vertices) + np.arange(len(a))
        vertices = np.vstack([vertices, (weights * vertices[faces[split]]).sum(axis=1)])
        parts = [np.column_stack(corners) for corners in ((a, b, new), (b, c, new), (c, a, new))]
        faces = np.vstack([faces[~split], *parts])
    return vertices, faces


def _thin_faces(subject: str, rng: Rng) -> Figures:
    """A mesh against even samples of it."""
    makers = {"prism": _prism, "can": _can}
    if subject in makers:
        vertices, faces, plane = in_pose(*makers[subject](rng), Plane((1, 0, 0), 0.0), rng)
    else:
        vertices, faces, plane = symmetric(subject, rng)
        vertices, faces = _cut_up((vertices, faces), rng)
    points = sampled(vertices, faces, COUNT, rng)
    mesh = symsurf.detect(vertices, faces=faces, threads=1)
    even, _ = timed_detect(points, "auto")
    angle = np.inf
    if isinstance(mesh.mirror, Plane):
        angle, _ = difference(mesh.mirror, plane, points)
    kind = mesh.mirror.kind if mesh.mirror else ""
    return {
        "off even": abs(mesh.score - even.score),
        "angle": angle,
        "kind plane": float(kind == "plane"),
        "mesh": mesh.score,
        "even": even.score,
        "true, even": matched(points, plane),
        "seconds": mesh.seconds,
    }


CASES = (
    _drift("clean", 0),
    _drift("noise 1 %", 0.01),
    _uneven(3, 0.95),
    _uneven(5, 0.9),
    Case("judgement, one side cut", MIRRORED, _cut, {"off": at_most(0.05), "monotone": at_least(1)}),
    Case("judgement, cut, result over the true plane", SYMMETRIC, _below,
         {"never below": at_least(1)}),
    Case("judgement, meshes of thin faces", ("prism", "can", "chair", "aircraft", "rifle"),
         _thin_faces, {"off even": at_most(0.03), "angle": at_most(0.3)}),
)  # fmt: skip
