"""Triangulations that are the mirror images of themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_MOST_FAILURES = 100  # of where a map is begun, before the triangulation counts as not symmetric
# Of the vertices with the guess. Other maps of a regular triangulation agree nearly nowhere; where the
# guess slid by an edge over most of a regular one, the right map still had 0.4.
_LEAST_AGREEMENT = 0.25


def mirrored_vertices(
    faces: NDArray[np.int64], guess: NDArray[np.int64]
) -> NDArray[np.int64] | None:
    """Of each vertex (k,) the one that mirrors it, where the faces are mirrored with it; else None.

    A map of triangulations is known from a face and its image on: each edge has one face on either
    side. So it is begun where the guess maps a face to a face, and is right if it meets itself.

    Args:
        faces: (m, 3), wound alike.
        guess: (k,) vertices near to the true ones, -1 for none.
    """
    third = {(int(face[i]), int(face[i - 2])): int(face[i - 1]) for face in faces for i in range(3)}
    images = np.full(len(guess), -1)
    failures = 0
    # In any order but the file's, in which neighbours, wrong together, follow each other.
    for a, b, c in np.random.default_rng(0).permutation(faces).tolist():
        if images[a] >= 0 or third.get((guess[b], guess[a])) != guess[c]:
            continue
        grown = _grown(third, {a: int(guess[a]), b: int(guess[b])}, (a, b))
        own = np.fromiter(grown, np.int64, len(grown))
        mapped = np.fromiter(grown.values(), np.int64, len(grown))
        if len(own) and (guess[own] == mapped).mean() > _LEAST_AGREEMENT:
            images[own] = mapped
        elif (failures := failures + 1) > _MOST_FAILURES:
            return None
    used = np.unique(faces)
    is_mirrored = len(used) == len(guess) and (images >= 0).all()
    return images if is_mirrored and (images[images] == np.arange(len(images))).all() else None


def _grown(
    third: dict[tuple[int, int], int], images: dict[int, int], start: tuple[int, int]
) -> dict[int, int]:
    """The map from an edge on, over all faces that hang together; empty where it does not hold."""
    edges = [start, start[::-1]]
    seen: set[tuple[int, int]] = set()
    while edges:
        a, b = edges.pop()
        if (a, b) in seen:
            continue
        c, image = third.get((a, b)), third.get((images[b], images[a]))
        if c is None and image is None:
            continue
        if c is None or image is None or images.setdefault(c, image) != image:
            return {}
        seen.update(((a, b), (b, c), (c, a)))
        edges += [(c, b), (a, c)]
    return images
