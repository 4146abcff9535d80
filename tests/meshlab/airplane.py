"""An airplane with one wing bent up, to see on a screen: PyVista's, whose halves are alike."""

from __future__ import annotations

from pathlib import Path

import numpy as np

BENT = 0.03  # how far the tip of the wing is off, as a share of the diagonal


def bent_airplane() -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles, seen from the front, from above and from the side."""
    from pyvista import examples

    mesh = examples.load_airplane().triangulate()
    points, faces = np.array(mesh.points, float), mesh.faces.reshape(-1, 4)[:, 1:]
    for _ in range(2):
        points, faces = with_midpoints(points, faces)
    size = np.ptp(points, axis=0)
    points -= points.min(axis=0) + size / 2
    outwards = np.clip(2 * points[:, 0] / size[0] - 0.2, 0, None) / 0.8
    points[:, 2] += BENT * np.linalg.norm(size) * outwards**2
    return points @ seen_from(turn=-0.85, tilt=0.5), faces


def with_midpoints(points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each triangle in four."""
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, edge = np.unique(edges, axis=0, return_inverse=True)
    middle = len(points) + edge.reshape(-1, 3)
    corners = [np.stack([faces[:, k], middle[:, k], middle[:, k - 1]], axis=1) for k in range(3)]
    return np.vstack([points, points[edges].mean(axis=1)]), np.vstack([*corners, middle])


def seen_from(turn: float, tilt: float) -> np.ndarray:
    """What takes z, the airplane's up, to the screen's y, then turns about it and tilts."""
    upright = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]], float)
    c, s = np.cos(turn), np.sin(turn)
    turned = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    c, s = np.cos(tilt), np.sin(tilt)
    return upright @ turned @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]])


def write_obj(file: Path, points: np.ndarray, faces: np.ndarray) -> Path:
    """Without pymeshlab, whose writer reports to a log that may be gone with its mesh set."""
    lines = ["v {:.9g} {:.9g} {:.9g}".format(*p) for p in points]
    lines += ["f {} {} {}".format(*f) for f in faces + 1]
    file.write_text("\n".join(lines) + "\n")
    return file
