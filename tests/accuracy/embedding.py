"""What Lipman et al. show of the Symmetry Factored Embedding, on shapes made of known orbits."""

from __future__ import annotations

import time

import numpy as np

import symsurf

from .case import Case, Figures, at_least, at_most
from .poses import random_rotation

BLOBS = 5
GROUPS = {"mirror": (1, True), "three-fold": (3, False), "five-fold, mirrors": (5, True),
          "gear of 24": (24, True), "none": (1, False)}  # fmt: skip
STATIONARY = {"mirror": "plane", "three-fold": "line", "five-fold, mirrors": "line",
              "gear of 24": "line", "none": "none"}  # fmt: skip


def _elements(name: str) -> list[np.ndarray]:
    order, mirrors = GROUPS[name]
    angles = 2 * np.pi * np.arange(order) / order
    turns = [np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
             for a in angles]  # fmt: skip
    return [t @ np.diag((s, 1, 1)) for t in turns for s in ((1, -1) if mirrors else (1,))]


def sampled_orbits(
    name: str, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """About `count` points, and the orbit of each: the images of some random blobs."""
    elements = _elements(name)
    each = count // len(elements)
    middles = rng.uniform(-1, 1, size=(BLOBS, 3)) + (0, 1, 0)
    seeds = middles[rng.integers(BLOBS, size=each)] + 0.15 * rng.normal(size=(each, 3))
    points = np.vstack([seeds @ element.T for element in elements])
    return points, np.tile(np.arange(each), len(elements))


def _placed(name: str, count: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    points, orbits = sampled_orbits(name, count, rng)
    return points @ random_rotation(rng).T + rng.normal(size=3), orbits


def _factored(name: str, rng: np.random.Generator) -> Figures:
    """Orbits, the stationary set, and the largest distance within orbits over the mean of all."""
    points, orbits = _placed(name, 2400, rng)
    found = symsurf.symmetry_embedding(points)
    pairs = {(a, b) for a, b in zip(orbits.tolist(), found.orbit.tolist(), strict=True)}
    first = np.unique(orbits, return_index=True)[1][orbits]
    within = np.linalg.norm(found.embedding - found.embedding[first], axis=1).max()
    scale = np.linalg.norm(found.embedding - found.embedding.mean(axis=0), axis=1).mean()
    return {
        "orbits": float(len(pairs) == len(set(orbits)) == found.statistics["orbits"]),
        "stationary set": float(found.stationary_set == STATIONARY[name]),
        "within orbits": float(within / scale),
    }


def _noisy(name: str, rng: np.random.Generator, missing: float) -> Figures:
    """Noise of 0.5 % of the diagonal: distances within orbits beside those of random pairs."""
    points, orbits = _placed(name, 2400, rng)
    points += 0.005 * np.linalg.norm(np.ptp(points, axis=0)) * rng.normal(size=points.shape)
    away = np.linalg.norm(points - points[rng.integers(len(points))], axis=1)
    kept = np.argsort(away)[round(missing * len(points)) :]
    points, orbits = points[kept], orbits[kept]
    found = symsurf.symmetry_embedding(points, power=4)
    first = np.unique(orbits, return_index=True)[1][np.unique(orbits, return_inverse=True)[1]]
    within = np.linalg.norm(found.embedding - found.embedding[first], axis=1)
    moved = first != np.arange(len(first))
    others = np.linalg.norm(found.embedding - rng.permutation(found.embedding), axis=1)
    return {
        "stationary set": float(found.stationary_set == STATIONARY[name]),
        "within over between": float(within[moved].mean() / others.mean()),
    }


def _many(name: str, rng: np.random.Generator) -> Figures:
    points, _ = _placed(name, 100_000, rng)
    start = time.process_time()
    symsurf.symmetry_embedding(points, threads=1)
    return {"seconds": time.process_time() - start}


_SYMMETRIC = tuple(name for name in GROUPS if name != "none")
CASES = (
    Case("neighbours, embedding: Lipman, orbits and stationary sets", _SYMMETRIC, _factored,
         {"orbits": at_least(1), "stationary set": at_least(1), "within orbits": at_most(1e-3)},
         trials=10),
    *(Case(f"neighbours, embedding: Lipman, {title}", _SYMMETRIC,
           lambda name, rng, missing=missing: _noisy(name, rng, missing),
           {"within over between": at_most(0.5)}, trials=10)
      for title, missing in (("noise 0.5 %", 0), ("noise, and a tenth missing", 0.1))),
    Case("neighbours, embedding: 100,000 points", tuple(GROUPS), _many, {"seconds": at_most(5)},
         trials=5),
)  # fmt: skip
