# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes as arrays, and back."""

from dataclasses import dataclass

import numpy as np

# Of each type of attribute the property that has its numbers, how many these are, and their type.
_TYPES = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "INT8": ("value", 1, np.int32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color_srgb", 4, np.float32),
    "INT16_2D": ("value", 2, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "QUATERNION": ("value", 4, np.float32),
    "FLOAT4X4": ("value", 16, np.float32),
}
# Positions and corners are made anew, custom normals would be wrong.
_OWN = {"position", "custom_normal"}


def _values(collection, name, width, kind):
    made = np.empty(len(collection) * width, kind)
    collection.foreach_get(name, made)
    return made.reshape(-1, width) if width > 1 else made


def positions(points):
    """(n, 3) of vertices, or of the points of a shape key, in the object's own coordinates."""
    return _values(points, "co", 3, np.float32)


def set_positions(points, values):
    """Sets them from (n, 3)."""
    points.foreach_set("co", np.ascontiguousarray(values, np.float32).ravel())


@dataclass
class Triangles:
    """The triangles that polygons are divided into."""

    vertices: np.ndarray
    """(m, 3)"""
    loops: np.ndarray
    """(m, 3) their corners of the polygons."""
    polygons: np.ndarray
    """(m,)"""


def triangles_of(mesh):
    """The triangles of a mesh."""
    mesh.calc_loop_triangles()
    made = mesh.loop_triangles
    return Triangles(
        _values(made, "vertices", 3, np.int32).astype(np.int64),
        _values(made, "loops", 3, np.int32).astype(np.int64),
        _values(made, "polygon_index", 1, np.int32).astype(np.int64),
    )


def move_vertices(mesh, moved, new):
    """Gives those vertices of a mesh that are moved, (n,) booleans, new positions (n, 3); shape keys
    keep their offsets from them."""
    old = positions(mesh.vertices)
    new = np.where(moved[:, None], new, old).astype(np.float32)
    if mesh.shape_keys:
        for key in mesh.shape_keys.key_blocks:
            set_positions(key.data, positions(key.data) + (new - old))
    set_positions(mesh.vertices, new)
    mesh.update()


def set_attribute(mesh, name, values, domain="POINT", kind=None):
    """Gives a mesh an attribute from an array: a value, or three, a row; in place of another of that
    name. Gives the attribute."""
    if (old := mesh.attributes.get(name)) is not None:
        mesh.attributes.remove(old)
    if kind is None:
        kind = {"b": "BOOLEAN", "i": "INT"}.get(values.dtype.kind, "FLOAT")
        kind = "FLOAT_VECTOR" if values.ndim == 2 else kind
    field, _, number = _TYPES[kind]
    made = mesh.attributes.new(name, kind, domain)
    made.data.foreach_set(field, np.ascontiguousarray(values, number).ravel())
    return made


def attributes_of(mesh, domain):
    """What somebody gave the elements of a mesh: name, type and array of each attribute."""
    return [
        (each.name, each.data_type, _values(each.data, *_TYPES[each.data_type]))
        for each in mesh.attributes
        if each.domain == domain
        and each.data_type in _TYPES
        and each.name not in _OWN
        and not each.name.startswith(".")
    ]


def weights_of(shape):
    """(n, groups) the vertex groups of an object, 0 for vertices that are none of theirs."""
    made = np.zeros((len(shape.data.vertices), len(shape.vertex_groups)))
    if made.shape[1]:
        for vertex in shape.data.vertices:
            for each in vertex.groups:
                made[vertex.index, each.group] = each.weight
    return made


def set_weights(group, before, after):
    """Sets the weights (n,) of a vertex group where they change; a vertex of weight 0 leaves it."""
    changed = np.flatnonzero(np.abs(after - before) > 1e-7)  # rounding in single precision
    for index in changed[after[changed] > 0].tolist():
        group.add([index], float(after[index]), "REPLACE")
    group.remove(changed[after[changed] <= 0].tolist())
