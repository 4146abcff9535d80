"""A head-like mesh whose mirror and partners are known: quadrilaterals, two polygons at the poles, texture
coordinates, a material and weights."""

import bpy
import numpy as np
from mathutils import Euler, Matrix, Vector

PLACE = Matrix.LocRotScale(Vector((3, -2, 1)), Euler((0.3, 0.4, -0.5)), Vector((2, 2, 2)))


def _points(around, up):
    a = 2 * np.pi / around * np.arange(around)[:, None]
    b = np.linspace(0.4, np.pi - 0.4, up)[None, :]  # wide poles: no vertices are near each other
    x = np.stack([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b) + 0 * a], -1).reshape(
        -1, 3
    )

    def bump(direction, width, height):
        return height * np.exp((x @ (np.array(direction) / np.linalg.norm(direction)) - 1) / width)

    radius = 1 + 0.15 * np.sin(2 * x[:, 1] + x[:, 2]) + bump((0, -1, 0.25), 0.02, 0.4)
    for side in (-1, 1):
        radius += bump((side * 0.9, 0.1, 0.8), 0.03, 0.55) + bump(
            (side * 0.8, -1, -0.3), 0.05, 0.35
        )
    return (x * radius[:, None] * (1, 1.2, 1.1)).astype(np.float32)


def partners(around, up):
    """(n,) of each vertex the one that mirrors it over x = 0."""
    i, j = np.divmod(np.arange(around * up), up)
    return (around // 2 - i) % around * up + j


def head(around=40, up=24, place=PLACE, name="Head"):
    """The active object, mirrored over x = 0 of its own coordinates to the last bit, and the partners."""
    points, partner = _points(around, up), partners(around, up)
    mirrored = points[partner] * np.float32((-1, 1, 1))
    points = np.where(points[:, :1] < 0, mirrored, points)
    points[partner == np.arange(len(partner)), 0] = 0
    i, j = (
        each.ravel() for each in np.meshgrid(np.arange(around), np.arange(up - 1), indexing="ij")
    )
    after = (i + 1) % around
    quads = np.stack([i * up + j, i * up + j + 1, after * up + j + 1, after * up + j], -1)
    poles = [np.arange(around) * up, np.arange(around)[::-1] * up + up - 1]
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points.tolist(), [], [*quads.tolist(), *(each.tolist() for each in poles)])
    set_uv(mesh, points)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    made.matrix_world = place
    bpy.context.view_layer.update()
    return made, partner


def uv_of(points):
    """The texture coordinates of points: of each side the same, and linear."""
    return points[..., 1:] * 0.25 + 0.5


def set_uv(mesh, points):
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    layer = mesh.uv_layers.new(name="Skin")
    layer.data.foreach_set("uv", uv_of(points[corners]).ravel().astype(np.float32))


def coordinates(shape):
    made = np.empty(3 * len(shape.data.vertices), np.float32)
    shape.data.vertices.foreach_get("co", made)
    return made.reshape(-1, 3)


def set_coordinates(shape, points):
    shape.data.vertices.foreach_set("co", np.float32(points).ravel())
    shape.data.update()


def in_scene(shape):
    """(n, 3) in the scene's coordinates, in double precision."""
    matrix = np.array(shape.matrix_world, dtype=np.float64)
    return coordinates(shape) @ matrix[:3, :3].T + matrix[:3, 3]


def uv(shape):
    made = np.empty(2 * len(shape.data.loops), np.float32)
    shape.data.uv_layers["Skin"].data.foreach_get("uv", made)
    return made.reshape(-1, 2)


def polygons(shape):
    """The vertices of each polygon."""
    return [tuple(each.vertices) for each in shape.data.polygons]


def values(shape, name, field="value", width=1):
    data = shape.data.attributes[name].data
    made = np.empty(len(data) * width, np.float32)
    data.foreach_get(field, made)
    return made.reshape(-1, width) if width > 1 else made


def plane_of(place=PLACE):
    """Normal and a point of the mirror, x = 0 of the object, in the scene."""
    normal = np.array((place.to_3x3().inverted().transposed() @ Vector((1, 0, 0))).normalized())
    return normal, np.array(place.translation)


def asymmetry_of(points, partner, place=None):
    """The largest distance of a vertex from the image of its partner, over x = 0 or the known plane."""
    normal, middle = ((1, 0, 0), (0, 0, 0)) if place is None else plane_of(place)
    normal = np.asarray(normal, np.float64)
    images = points - 2 * ((points - middle) @ normal)[:, None] * normal
    return np.abs(images[partner] - points).max()


def dented(shape, seed=0, depth=0.001):
    """Noise on every vertex, far less than the spacing."""
    points = coordinates(shape)
    noise = np.random.default_rng(seed).normal(size=points.shape) * depth
    set_coordinates(shape, points + noise)
