# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of other vertices and faces, with what the old ones had."""

from dataclasses import dataclass

import numpy as np

from symsurf.results.operation_results import carried_values

from .meshes import attributes_of, set_attribute, set_positions, set_weights, weights_of


@dataclass
class _Corners:
    """The polygons of the new mesh, and where what their corners have comes from."""

    totals: np.ndarray
    """(p,) corners of each polygon."""
    polygons: np.ndarray
    """(p,) the old polygon that each comes from."""
    triangles: np.ndarray
    """(p,) of each that is a triangle of the result which one, -1 of the others."""
    points: np.ndarray
    """(c,) the vertex of each corner, polygon by polygon."""
    loops: np.ndarray
    """(c, k) the old corners that its values lie between."""
    shares: np.ndarray
    """(c, k) what each of these counts."""


def rebuild(shape, result, points, triangles):
    """Puts the points (n, 3) and faces of a result in place of a mesh; ``triangles``: those that it was
    made from.

    Polygons whose triangles are all there are polygons again. Vertex groups and attributes of
    vertices and corners, such as texture coordinates, lie between those of the old mesh, those of
    polygons and of edges that are left are kept.
    """
    mesh = shape.data
    corners = _corners_of(mesh, result, triangles)
    ends, weights = _edges_of(mesh), weights_of(shape)
    kept = {domain: attributes_of(mesh, domain) for domain in ("POINT", "CORNER", "FACE", "EDGE")}
    groups = [(group.name, group.lock_weight) for group in shape.vertex_groups]
    active = _active_layers(mesh)
    _set_geometry(mesh, points, corners)
    shape.vertex_groups.clear()
    for (name, is_locked), old in zip(groups, weights.T):
        group = shape.vertex_groups.new(name=name)
        set_weights(group, np.zeros(len(points)), result.carried(old))
        group.lock_weight = is_locked
    for name, kind, values in kept["POINT"]:
        set_attribute(mesh, name, result.carried(values), "POINT", kind)
    dominant = corners.loops[np.arange(len(corners.loops)), corners.shares.argmax(axis=1)]
    for name, kind, values in kept["CORNER"]:
        new = carried_values(values, dominant, corners.loops, corners.shares)
        set_attribute(mesh, name, new, "CORNER", kind)
    for name, kind, values in kept["FACE"]:
        set_attribute(mesh, name, values[corners.polygons], "FACE", kind)
    _keep_edges(mesh, result, ends, kept["EDGE"])
    _set_active_layers(mesh, active)
    return corners.triangles


def _set_geometry(mesh, points, corners):
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    set_positions(mesh.vertices, points)
    mesh.loops.add(len(corners.points))
    mesh.loops.foreach_set("vertex_index", corners.points.astype(np.int32))
    mesh.polygons.add(len(corners.totals))
    starts = np.cumsum(corners.totals) - corners.totals
    mesh.polygons.foreach_set("loop_start", starts.astype(np.int32))
    mesh.update(calc_edges=True)


def _corners_of(mesh, result, triangles):
    faces, origins = result.shape.faces, result.face_sources
    loops, shares = _triangle_corners(len(mesh.vertices), result, triangles)
    starts, totals = (np.empty(len(mesh.polygons), np.int32) for _ in range(2))
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.polygons.foreach_get("loop_total", totals)

    # Triangles with the corners of their source, and whether they are its image, turned round.
    new, old = loops[:, :, 0], triangles.loops[origins]
    whole = (shares[:, :, 0] == 1).all(axis=1)
    whole &= (np.sort(new, axis=1) == np.sort(old, axis=1)).all(axis=1)
    turned = _is_even(np.argsort(new, axis=1)) != _is_even(np.argsort(old, axis=1))
    is_image = turned.astype(np.int64)

    # Of the polygons, and behind them of their images, those whose triangles are all there.
    count = len(totals)
    group = triangles.polygons[origins] + count * is_image
    needed = np.tile(np.bincount(triangles.polygons, minlength=count), 2)
    is_complete = (np.bincount(group[whole], minlength=len(needed)) == needed) & (needed > 0)
    joined = whole & is_complete[group]
    point_of = np.zeros((2, len(mesh.loops)), np.int64)
    point_of[is_image[joined][:, None], loops[joined, :, 0]] = faces[joined]
    turned, old = np.divmod(np.flatnonzero(is_complete), count)
    own, place = _ragged(totals[old])
    last = totals[old][own] - 1
    corner = starts[old][own] + np.where(turned[own] == 1, last - place, place)

    left = np.flatnonzero(~joined)
    width = loops.shape[2]
    own_loops = np.repeat(corner[:, None], width, axis=1)
    own_shares = np.zeros((len(corner), width))
    own_shares[:, 0] = 1
    return _Corners(
        totals=np.concatenate([totals[old], np.full(len(left), 3)]),
        polygons=np.concatenate([old, triangles.polygons[origins[left]]]),
        triangles=np.concatenate([np.full(len(old), -1), left]),
        points=np.concatenate([point_of[turned[own], corner], faces[left].ravel()]),
        loops=np.concatenate([own_loops, loops[left].reshape(-1, width)]),
        shares=np.concatenate([own_shares, shares[left].reshape(-1, width)]),
    )


def _is_even(orders):
    """Whether permutations (m, 3) turn (0, 1, 2) without exchanging two of them."""
    return (orders[:, 1] - orders[:, 0]) % 3 == 1


def _triangle_corners(count, result, triangles):
    """(m, 3, k) of each corner of the result's triangles, the old corners that its values lie between:
    of the source triangle where it has them, else any of the same vertices; and their shares, the
    largest first."""
    parents, shares = result.parents, result.shares
    if parents is None:
        parents, shares = result.sources[:, None], np.ones((len(result.sources), 1))
    largest_first = np.argsort(-shares, axis=1, kind="stable")
    parents, shares = (np.take_along_axis(each, largest_first, 1) for each in (parents, shares))
    of_vertex = np.zeros(count, np.int64)
    of_vertex[triangles.vertices[::-1].ravel()] = triangles.loops[::-1].ravel()
    sources = result.face_sources
    corners = parents[result.shape.faces]
    loops = of_vertex[corners]
    for k in range(3):
        is_here = corners == triangles.vertices[sources, k][:, None, None]
        loops = np.where(is_here, triangles.loops[sources, k][:, None, None], loops)
    return loops, shares[result.shape.faces]


def _ragged(totals):
    """Of rows of so many elements each, one behind the other: the row of each, and its place there."""
    row = np.repeat(np.arange(len(totals)), totals)
    return row, np.arange(len(row)) - np.repeat(np.cumsum(totals) - totals, totals)


def _edges_of(mesh):
    ends = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", ends)
    return np.sort(ends.reshape(-1, 2).astype(np.int64), axis=1)


def _keep_edges(mesh, result, old, attributes):
    """What edges had, as far as both of their ends are left."""
    if not attributes or not len(old):
        return
    count = old.max() + 1
    keys = old @ (count, 1)
    order = np.argsort(keys)
    ends = np.sort(result.sources[_edges_of(mesh)], axis=1)
    wanted = ends @ (count, 1)
    place = order[np.searchsorted(keys, wanted, sorter=order).clip(max=len(keys) - 1)]
    is_known = (keys[place] == wanted) & (ends[:, 1] < count)
    for name, kind, values in attributes:
        new = values[place]
        new[~is_known] = 0
        set_attribute(mesh, name, new, "EDGE", kind)


def _active_layers(mesh):
    colours = mesh.color_attributes
    shown = mesh.uv_layers.active
    return (
        shown.name if shown else "",
        colours.active_color_name,
        colours.default_color_name,
    )


def _set_active_layers(mesh, active):
    if active[0] in mesh.uv_layers:
        mesh.uv_layers.active = mesh.uv_layers[active[0]]
    for property_, name in zip(("active_color_name", "default_color_name"), active[1:]):
        if name in mesh.color_attributes:
            setattr(mesh.color_attributes, property_, name)
