"""Gaussian splats: the centres move, the ellipsoids turn and stretch with them, the colours stay."""

from __future__ import annotations

import numpy as np

from ...reading.splat import SPLAT
from .new_shape import NewShape, Rewritten


def rewritten_splat(content: bytes, new: NewShape) -> Rewritten:
    table = np.frombuffer(content, SPLAT)
    made = table[new.sources]
    made["position"] = new.points
    made["colour"] = new.of_file(b"colour", table["colour"])
    if new.directed is not None:
        turns = (table["rotation"].astype(float) - 128) / 128
        with np.errstate(divide="ignore"):  # flat ones have an axis of 0
            given = np.hstack([turns, np.log(table["scale"].astype(float))])
        moved = new.directed(given, "ellipsoid", "rotation")
        changed = (moved != given[new.sources]).any(axis=1)  # others keep their bytes
        turns = moved[changed, :4] / np.linalg.norm(moved[changed, :4], axis=1, keepdims=True)
        made["rotation"][changed] = np.clip(np.round(128 * turns + 128), 0, 255)
        made["scale"][changed] = np.exp(moved[changed, 4:])
    return Rewritten(made.tobytes(), new.lost_arrays("SPLAT"))
