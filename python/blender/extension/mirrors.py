# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors as objects of the scene."""

import json

import bpy
import numpy as np
from mathutils import Matrix

import symsurf

_KEY, _AXIS = "symsurf_mirror", "symsurf_axis"
_COLOUR = (0.45, 0.7, 0.95, 0.5)
# Off the identity, matrices that objects inherit from their parents are by rounding in single precision.
_SAME = 1e-5
_UPRIGHT = 1e-6  # likewise, off a coordinate axis


def matrix_of(object_):
    """(4, 4) from the coordinates of an object to those of the scene."""
    return np.array(object_.matrix_world, dtype=np.float64)


def applied(matrix, points):
    """The points (n, 3) under a matrix (4, 4)."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def serves(object_):
    """Whether an object can stand for a mirror."""
    return _KEY in object_ or object_.type in ("MESH", "EMPTY")


def text_of(object_):
    """What is known of the mirror that an object stands for, in a few words."""
    if _KEY not in object_:
        return "The plane across its Z axis"
    found = json.loads(object_[_KEY])
    return f"{found['kind'].capitalize()}, {found['text']}"


def draw(context, shape, mirror, name, text, mesh=None):
    """Adds an object for a mirror, in the scene's coordinates: the shape's child, and not rendered."""
    vertices, triangles = mirror.mesh() if mesh is None else mesh
    drawn = _child(context, shape, name, vertices, faces=triangles)
    drawn[_KEY] = json.dumps(
        {"kind": mirror.kind, "numbers": mirror.numbers, "text": text}, default=np.ndarray.tolist
    )
    return drawn


def _child(context, shape, name, vertices, edges=(), faces=()):
    """A new object of these, in the scene's coordinates."""
    data = bpy.data.meshes.new(name)
    data.from_pydata(np.asarray(vertices).tolist(), list(edges), np.asarray(faces).tolist())
    data.materials.append(_material())
    drawn = bpy.data.objects.new(name, data)
    (shape.users_collection or [context.scene.collection])[0].objects.link(drawn)
    drawn.parent = shape
    drawn.matrix_parent_inverse = shape.matrix_world.inverted_safe()
    drawn.hide_render = True
    return drawn


def _remove_drawn(shape):
    for child in list(shape.children):
        if _KEY in child or _AXIS in child:
            bpy.data.meshes.remove(child.data)  # and the object with it


def draw_found(context, shape, result, others=()):
    """Draws what a detection found, in place of what was drawn for the shape before."""
    _remove_drawn(shape)
    text = f"score {result.score:.3f}"
    shape.symsurf_mirror = draw(context, shape, result.mirror, f"Mirror of {shape.name}", text)
    for number, each in enumerate(others, 2):
        mesh = each.mirror.mesh(result.points)
        name = f"Mirror {number} of {shape.name}"
        draw(context, shape, each.mirror, name, f"score {each.score:.3f}", mesh)


def draw_symmetries(context, shape, result):
    """Draws mirror planes and rotation axes, in place of what was drawn for the shape before; the first
    plane becomes its mirror."""
    _remove_drawn(shape)
    points = result.shape.points
    shape.symsurf_mirror = None
    for number, plane in enumerate(result.planes, 1):
        name = f"Plane {number} of {shape.name}"
        drawn = draw(context, shape, plane, name, result.group, plane.mesh(points))
        shape.symsurf_mirror = shape.symsurf_mirror or drawn
    for number, axis in enumerate(result.axes, 1):
        along = (points - axis.point) @ axis.direction
        beyond = 0.1 * np.ptp(along)  # at either end
        ends = np.array([[along.min() - beyond], [along.max() + beyond]]) * axis.direction
        order = "∞" if axis.continuous else axis.order
        name = f"Axis {number} of {shape.name}, order {order}"
        line = _child(context, shape, name, axis.point + ends, [(0, 1)])
        line[_AXIS] = result.group


def mirror_and_frame(shape):
    """The mirror that the shape's setting names, None for none, and the matrix (4, 4) that takes the
    shape's points to where this mirror is.

    Planes are taken to the scene's coordinates. A curved mirror stays as it was found; where it, or
    the shape with it, was moved since then, the points are taken back.
    """
    drawn, world = shape.symsurf_mirror, matrix_of(shape)
    if drawn is None:
        return None, world
    if _KEY not in drawn:
        return moved_plane(symsurf.Plane((0, 0, 1), 0), matrix_of(drawn)), world
    found = json.loads(drawn[_KEY])
    numbers = {
        name: np.array(value) if isinstance(value, list) else value
        for name, value in found["numbers"].items()
    }
    mirror, moved = symsurf.make_mirror(found["kind"], numbers), matrix_of(drawn)
    if np.abs(moved - np.eye(4)).max() <= _SAME:
        return mirror, world
    if mirror.kind == "plane":
        return moved_plane(mirror, moved), world
    return mirror, np.linalg.inv(moved) @ world


def moved_plane(plane, matrix):
    """The plane under a matrix (4, 4), across a coordinate axis where it is so to rounding."""
    moved = np.linalg.inv(matrix).T @ (*plane.normal, plane.offset)
    moved /= np.linalg.norm(moved[:3])
    normal = np.where(np.abs(moved[:3]) < _UPRIGHT, 0, moved[:3])
    return symsurf.Plane(normal, moved[3])


def move(shape, mirror, matrix, points):
    """Moves what was drawn for the mirror of a shape after its points were moved by a matrix (4, 4) in
    the mirror's coordinates, to ``points`` (n, 3). A plane comes to lie there exactly, across an axis."""
    drawn = shape.symsurf_mirror
    if drawn is None or _KEY not in drawn:
        return
    drawn.matrix_world = Matrix(matrix if mirror.kind != "plane" else np.eye(4))
    if mirror.kind == "plane":
        plane = moved_plane(mirror, matrix)
        if plane.normal.sum() < 0:  # positive is where the coordinate is
            plane = symsurf.Plane(-plane.normal, -plane.offset)
        found = json.loads(drawn[_KEY]) | {"numbers": plane.numbers}
        drawn[_KEY] = json.dumps(found, default=np.ndarray.tolist)
        vertices, triangles = plane.mesh(points)
        drawn.data.clear_geometry()
        drawn.data.from_pydata(vertices.tolist(), [], triangles.tolist())


def _material():
    """Translucent, also where the view is shaded solid."""
    name = "symsurf mirror"
    if (made := bpy.data.materials.get(name)) is None:
        made = bpy.data.materials.new(name)
        made.diffuse_color = _COLOUR
    return made
