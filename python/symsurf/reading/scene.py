"""Scenes of meshes, by trimesh: GLB, GLTF and 3MF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from ..shape import Shape


def read(path: Path, threshold: float | None, scalars: str | None) -> Shape:
    """All meshes and clouds of the scene, each where the scene has it, as one shape.

    The axes are those of the file: in glTF y is up.
    """
    # Unprocessed, as merging vertices would change their order.
    scene = trimesh.load_scene(path, process=False)
    points: list[np.ndarray] = []
    faces: list[np.ndarray] = []
    count = 0
    for part in scene.dump():
        points.append(np.asarray(part.vertices, dtype=np.float64).reshape(-1, 3))
        own = np.asarray(getattr(part, "faces", ()), dtype=np.int64).reshape(-1, 3)
        faces.append(own + count)
        count += len(points[-1])
    triangles = np.concatenate(faces) if faces else np.empty((0, 3), np.int64)
    return Shape(
        np.concatenate(points) if points else np.empty((0, 3)),
        triangles if len(triangles) else None,
    )
