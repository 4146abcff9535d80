"""Springs, threads, drills and twisted prisms of random measures, as meshes, points and noisy points."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import symsurf

from .case import Case, Figures, at_least, at_most
from .damage import noise
from .poses import Points, random_rotation
from .solids import sampled

COUNT = 3000


@dataclass(frozen=True)
class Mesh:
    points: Points
    faces: NDArray[np.int64]

    def __add__(self, other: Mesh) -> Mesh:
        return Mesh(
            np.vstack([self.points, other.points]),
            np.vstack([self.faces, other.faces + len(self.points)]),
        )


def tube(rings: Points) -> Mesh:
    """The triangles between rings (n, k, 3), and two fans that close the ends."""
    n, k = rings.shape[:2]
    i, j = np.meshgrid(np.arange(n - 1), np.arange(k), indexing="ij")
    a, b = i * k + j, i * k + (j + 1) % k
    faces = [np.stack([a, b, b + k], -1), np.stack([a, b + k, a + k], -1)]
    around = np.arange(k)
    for ring, middle in ((0, n * k), (n - 1, n * k + 1)):
        corners = ring * k + np.stack([around, (around + 1) % k], -1)
        faces.append(np.insert(corners, 2, middle, axis=1)[None])
    points = np.vstack([rings.reshape(-1, 3), rings[[0, -1]].mean(axis=1)])
    return Mesh(points, np.concatenate([face.reshape(-1, 3) for face in faces]))


def turned(radius, low: float, high: float, steps: int, around: int = 72) -> Mesh:
    """The body of radius(angle, z) about the z axis."""
    z, angle = np.meshgrid(np.linspace(low, high, steps), np.linspace(0, 2 * np.pi, around, endpoint=False), indexing="ij")  # fmt: skip
    r = radius(angle, z)
    return tube(np.stack([r * np.cos(angle), r * np.sin(angle), z], -1))


def polygon(sides: int, angle):
    """The radius of a regular polygon in the unit circle."""
    half = np.pi / sides
    return np.cos(half) / np.cos((angle + half) % (2 * half) - half)


def spring(wire: float, pitch: float, turns: float) -> Mesh:
    """Right-handed, of radius 1."""
    t = np.linspace(0, 2 * np.pi * turns, int(40 * turns))
    rise = np.full_like(t, pitch / (2 * np.pi))
    along = np.stack([-np.sin(t), np.cos(t), rise], -1)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    inward = np.stack([-np.cos(t), -np.sin(t), 0 * t], -1)
    angle = np.linspace(0, 2 * np.pi, 14, endpoint=False)[:, None]
    middle = np.stack([np.cos(t), np.sin(t), t * rise], -1)
    return tube(
        middle[:, None]
        + wire
        * (np.cos(angle) * inward[:, None] + np.sin(angle) * np.cross(along, inward)[:, None])
    )


def helical(subject: str, rng: np.random.Generator) -> tuple[Mesh, float]:
    """A right-handed body about the z axis and its pitch."""
    u = rng.uniform
    if subject == "spring":
        wire = u(0.08, 0.25)
        pitch = u(2.5, 6) * wire
        return spring(wire, pitch, u(2.2, 9)), pitch
    if subject == "bolt":
        pitch, length, starts = u(0.14, 0.3), u(1.2, 2.5), int(rng.choice([1, 1, 2]))

        def thread(angle, z):
            phase = (z / pitch - starts * angle / (2 * np.pi)) % 1
            return 0.5 - 0.55 * pitch * np.abs(2 * phase - 1)

        body = turned(thread, 0, length, int(14 * length / pitch), 64)
        if rng.random() < 0.6:
            shank = length + u(0.1, 1)
            body += turned(lambda angle, z: 0.5 + 0 * z, length, shank, 12, 64)
            length = shank
        if rng.random() < 0.7:
            body += turned(lambda angle, z: 0.95 * polygon(6, angle), length, length + 0.65, 8, 96)
        return body, starts * pitch
    if subject == "drill":
        pitch, length, flutes, depth = u(2, 8), u(3, 8), int(rng.integers(1, 4)), u(0.25, 0.5)

        def fluted(angle, z):
            return 1 - depth * (0.5 + 0.5 * np.cos(flutes * (angle - 2 * np.pi * z / pitch))) ** 2

        body = turned(fluted, 0, length, int(60 * length / pitch) + 20)
        if rng.random() < 0.6:
            body += turned(
                lambda angle, z: fluted(angle, 0) * (1 + 1.66 * z).clip(1e-3), -0.6, 0, 10
            )
        if rng.random() < 0.6:
            body += turned(lambda angle, z: 1 + 0 * z, length, length + u(1, 3), 20)
        return body, pitch
    sides, length = int(rng.integers(3, 7)), u(2, 6)
    pitch = length / u(0.25, 1.5)
    return turned(
        lambda angle, z: polygon(sides, angle - 2 * np.pi * z / pitch), 0, length, 60, 120
    ), pitch


def plain(subject: str, rng: np.random.Generator) -> Mesh:
    """A body without a helix."""
    u = rng.uniform
    if subject == "vase":
        waves = rng.normal(size=4)[:, None, None]
        k = np.arange(1, 5)[:, None, None]
        return turned(
            lambda angle, z: (1 + 0.2 * (waves * np.sin(k * z + waves)).sum(0)).clip(0.15), 0, 4, 60
        )
    if subject == "ribbed bar":
        pitch = u(0.15, 0.4)
        return turned(
            lambda angle, z: 1 - 0.5 * pitch * np.abs(2 * ((z / pitch) % 1) - 1), 0, 3, 200
        )
    if subject == "blob":
        ways, phases = 1.5 * rng.normal(size=(6, 3)), u(0, 6, size=6)
        polar, angle = np.meshgrid(np.linspace(1e-3, np.pi - 1e-3, 50), np.linspace(0, 2 * np.pi, 80, endpoint=False), indexing="ij")  # fmt: skip
        ball = np.stack([np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar)], -1)  # fmt: skip
        return tube(ball * (1 + 0.1 * np.sin(ball @ ways.T + phases).sum(-1, keepdims=True)))
    if subject == "torus":
        thick = u(0.2, 0.6)
        t = np.linspace(0, 2 * np.pi, 80)[:, None]
        w = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        r = 1 + thick * np.cos(w)
        return tube(np.stack([r * np.cos(t), r * np.sin(t), thick * np.sin(w) + 0 * t], -1))
    if subject == "gear":
        teeth = int(rng.integers(6, 24))
        return turned(
            lambda angle, z: 1 - 0.15 * (np.cos(teeth * angle) > 0), 0, u(0.3, 2), 20, 480
        )
    if subject == "cone":
        slope = u(0, 0.33)
        return turned(lambda angle, z: 1 - slope * z, 0, 2.9, 40)
    sides = 4 if subject == "box" else int(rng.integers(3, 9))
    body = turned(lambda angle, z: polygon(sides, angle), 0, u(0.6, 5), 40, 24 * sides)
    return (
        Mesh(body.points * u(0.5, 2, size=3), body.faces)
        if subject == "box"
        else Mesh(body.points, body.faces)
    )


def _found(
    mesh: Mesh, share: float | None, rng: np.random.Generator
) -> tuple[symsurf.HelicalSymmetry, float]:
    """Of the mesh, or where a share of noise is given of points."""
    start = time.process_time()
    if share is None:
        found = symsurf.helical_symmetry(mesh.points, faces=mesh.faces, threads=1)
    else:
        points = noise(sampled(mesh.points, mesh.faces, COUNT, rng), share, rng)
        start = time.process_time()
        found = symsurf.helical_symmetry(points, threads=1)
    return found, time.process_time() - start


def _case(name: str, share: float | None) -> Case:
    def run(subject: str, rng: np.random.Generator) -> Figures:
        mesh, pitch = helical(subject, rng)
        rotation, is_left, size = random_rotation(rng), rng.random() < 0.5, rng.uniform(0.2, 5)
        hand = (1, -1 if is_left else 1, 1)
        posed = Mesh(size * mesh.points * hand @ rotation.T + rng.normal(size=3), mesh.faces)
        found, seconds = _found(posed, share, rng)
        figures = {"found": float(found.verdict == "found"), "seconds": seconds}
        if not found.axis:
            return {**figures, "right": 0.0}
        angle = np.degrees(np.arccos(min(1, abs(found.axis.direction @ rotation[:, 2]))))
        error = abs(found.pitch / (size * pitch) - 1)
        agrees = found.handedness == ("left" if is_left else "right")
        return {
            **figures,
            "right": float(angle < 1 and error < 0.02 and agrees),
            "axis error": angle,
            "pitch error": error,
            "score": found.score,
            "evidence": found.statistics["evidence"],
        }

    bars = {"right": at_least(0.95), "axis error": at_most(0.5), "pitch error": at_most(0.01)}
    return Case(f"helical_symmetry, {name}", ("spring", "bolt", "drill", "prism"), run, bars, 40)


def _others(subject: str, rng: np.random.Generator) -> Figures:
    found, seconds = _found(plain(subject, rng), rng.choice([None, 0, 0.01]), rng)
    return {
        "verdict none": float(found.verdict == "none"),
        "score": found.score,
        "evidence": found.statistics["evidence"],
        "seconds": seconds,
    }


CASES = (
    _case("meshes", None),
    _case("points", 0),
    _case("noise 0.5 %", 0.005),
    Case("helical_symmetry, no helix",
         ("vase", "prism", "box", "blob", "torus", "ribbed bar", "cone", "gear"),
         _others, {"verdict none": at_least(0.97)}, 40),
)  # fmt: skip
