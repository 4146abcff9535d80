# SPDX-License-Identifier: GPL-3.0-or-later
"""What operations give, put into an object of Blender."""

import numpy as np
from bpy.props import EnumProperty
from mathutils import Matrix

import symsurf

from . import mirrors, values
from .colours import colours_of
from .meshes import move_vertices, positions, set_attribute, set_positions
from .mirrors import applied
from .rebuilding import rebuild

_LEAST = 1e-3  # of the diagonal: what is symmetric to rounding is not coloured as if it were not
# Of triangles, which Blender's polygons are divided into only for the while.
_NOT_SHOWN = {"face", "weights"}

MOVED = EnumProperty(
    name="Move",
    items=[
        (
            "MESH",
            "Mesh",
            "The vertices move, and location, rotation and scale are applied: for X Mirror",
        ),
        ("OBJECT", "Object", "The object moves, its mesh stays as it is"),
    ],
    description="What is moved",
)


def require_applicable(operation, parameters, shape):
    """Raises InvalidInput where the mesh cannot take what the operation will give."""
    gives_other = operation.adds_points or (
        operation.makes_shape and parameters.get("triangles") != "kept"
    )
    if gives_other and not operation.carries_values and shape.data.shape_keys:
        raise symsurf.InvalidInput(
            f"{operation.title} gives other vertices, and {shape.name} has shape keys; remove or "
            "apply them first"
        )


def apply(operator, context, shape, frame, triangles, result):
    """Puts the result of an operator's operation into the object that it was made from: ``frame`` (4,
    4) took its points to the mirror, ``triangles`` are what its polygons were divided into."""
    operation, faces = operator.operation, None
    if operation.carries_values:
        _carry(operator, shape, frame, result)
    elif operation.name == "align":
        _align(operator, context, shape, frame, result)
    elif result.is_other or operation.adds_points:
        points = applied(np.linalg.inv(frame), result.shape.points)
        faces = rebuild(shape, result, points, triangles)
    elif operation.moves_points:
        moved = (result.shape.points != result.given.points).any(axis=1)
        move_vertices(shape.data, moved, applied(np.linalg.inv(frame), result.shape.points))
    _set_arrays(shape.data, operation, result, faces)
    if operation.name == "straighten" and not operator.back:
        _draw_straight(context, shape, frame, result)
    shape.data.update()


def _carry(operator, shape, frame, result):
    if operator.vertex_groups:
        values.carry_weights(shape, result, operator.flip_names)
    if operator.shape_keys:
        values.carry_shape_keys(shape, result, frame, operator.flip_names)
    if operator.attributes:
        values.carry_attributes(shape, result)


def _align(operator, context, shape, frame, result):
    turned = result.matrix @ frame
    # As large as it is, where it was scaled since its mirror was found.
    world = mirrors.matrix_of(shape)
    size = np.cbrt(abs(np.linalg.det(world[:3, :3]) / np.linalg.det(turned[:3, :3])))
    scale = np.diag((size, size, size, 1.0))
    turned = scale @ turned
    if operator.move == "MESH":
        move_all(shape, turned)
        shape.matrix_world = Matrix()
    else:
        shape.matrix_world = Matrix(turned)
    context.view_layer.update()
    mirrors.move(shape, result.mirror, scale @ result.matrix, size * result.shape.points)


def move_all(shape, matrix):
    """Moves the vertices and shape keys of an object by a matrix (4, 4)."""
    points = [shape.data.vertices]
    if shape.data.shape_keys:
        points += [key.data for key in shape.data.shape_keys.key_blocks]
    for each in points:
        set_positions(each, applied(matrix, positions(each).astype(np.float64)))


def _draw_straight(context, shape, frame, result):
    """The plane that the mirror was laid into becomes the mirror of the object."""
    plane, points = result.plane, result.shape.points
    name = f"Straight mirror of {shape.name}"
    drawn = mirrors.draw(context, shape, plane, name, "of the straightened", plane.mesh(points))
    drawn.matrix_world = Matrix(mirrors.matrix_of(shape) @ np.linalg.inv(frame))
    shape.symsurf_mirror = drawn


def _set_arrays(mesh, operation, result, triangles):
    """The arrays of a result as attributes, and the one to show as colours. ``triangles``: of each
    polygon the triangle of the result, -1 for none, where the mesh was made from these."""
    for name, array in result.arrays.items():
        if name not in _NOT_SHOWN:
            set_attribute(mesh, f"{operation.name}_{name}", array)
    if triangles is not None:
        for name, array in result.face_arrays.items():
            of_polygons = array[triangles] & (triangles >= 0)
            set_attribute(mesh, f"{operation.name}_{name}", of_polygons, "FACE")
    (shown,) = [each for each in operation.arrays if each.name == operation.shown] or [None]
    if shown is not None and shown.type == "real":
        least = _LEAST * result.statistics["diagonal"] if shown.is_signed else 0
        colours = colours_of(result.arrays[shown.name], shown.is_signed, least)
        set_attribute(mesh, operation.title, colours, "POINT", "FLOAT_COLOR")
        mesh.color_attributes.active_color_name = operation.title
