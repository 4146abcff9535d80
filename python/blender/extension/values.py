# SPDX-License-Identifier: GPL-3.0-or-later
"""What the vertices of a mesh have, carried to the other side of its mirror."""

import bpy
import numpy as np

from .meshes import (
    attributes_of,
    positions,
    set_attribute,
    set_positions,
    set_weights,
    weights_of,
)
from .mirrors import applied


def _with_flipped(names, flips):
    """Each name with that of the other side: "arm.R" of "arm.L", itself where it has none."""
    made = {name: bpy.utils.flip_name(name) if flips else name for name in names}
    return made | {other: name for name, other in made.items()}


def _from_other(result, own, other, carried):
    """Values of which both sides have their own names: what a vertex has of itself is of its own name,
    what its counterparts give it is of the other."""
    share = result.shares[:, 0].reshape(-1, *[1] * (own.ndim - 1))
    return carried(other) + share * (own - other)


def carry_weights(shape, result, flips):
    """Carries the vertex groups of an object."""
    before = weights_of(shape)
    columns = {group.name: before[:, group.index] for group in shape.vertex_groups}
    none = np.zeros(len(before))
    for name, other in _with_flipped(columns, flips).items():
        own, others = columns.get(name, none), columns.get(other, none)
        new = _from_other(result, own, others, result.carried)
        group = shape.vertex_groups.get(name)
        if group is None and new.any():
            group = shape.vertex_groups.new(name=name)
        if group is not None:
            set_weights(group, own, new)


def carry_shape_keys(shape, result, frame, flips):
    """Carries the shape keys of an object, whose points the matrix ``frame`` (4, 4) takes to where the
    mirror is."""
    keys = shape.data.shape_keys
    if keys is None or not keys.use_relative:
        return
    relative = [key for key in keys.key_blocks if key != keys.reference_key]
    bases = {key.name: positions(key.relative_key.data) for key in relative}
    offsets = {
        key.name: (positions(key.data) - bases[key.name]) @ frame[:3, :3].T for key in relative
    }
    none = np.zeros_like(result.given.points)
    back = np.linalg.inv(frame)[:3, :3]
    for name, other in _with_flipped(offsets, flips).items():
        own, others = offsets.get(name, none), offsets.get(other, none)
        new = _from_other(result, own, others, result.displaced) @ back.T
        key = keys.key_blocks.get(name)
        if key is None and new.any():
            key = shape.shape_key_add(name=name, from_mix=False)
        if key is not None:
            set_positions(key.data, bases.get(name, positions(keys.reference_key.data)) + new)


def carry_attributes(shape, result):
    """Carries the attributes of the vertices of an object, such as colours."""
    for name, kind, values in attributes_of(shape.data, "POINT"):
        set_attribute(shape.data, name, result.carried(values), "POINT", kind)


def points_of(shape, frame):
    """(n, 3) the vertices of an object under the matrix ``frame`` (4, 4)."""
    return applied(frame, positions(shape.data.vertices).astype(np.float64))
