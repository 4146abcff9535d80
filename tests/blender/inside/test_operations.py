"""What operators do to a mesh whose mirror is known."""

import itertools
import json

import bpy
import numpy as np
import pytest
from heads import (
    PLACE,
    asymmetry_of,
    coordinates,
    dented,
    head,
    in_scene,
    plane_of,
    polygons,
    set_coordinates,
    set_uv,
    uv,
    uv_of,
    values,
)
from mathutils import Matrix, Vector

import symsurf

ROUNDING = 2e-6  # of coordinates below 8, in single precision


def test_every_operation_has_an_operator_with_its_parameters():
    for name, operation in symsurf.operations().items():
        properties = getattr(bpy.ops.symsurf, name).get_rna_type().properties
        assert {each.name for each in operation.parameters} <= set(properties.keys())
        assert properties.keys()
    methods = bpy.ops.symsurf.detect.get_rna_type().properties["method"].enum_items
    assert methods.keys() == list(symsurf.methods())


def test_detected_mirror_is_drawn_where_it_is():
    shape, _ = head()
    before = coordinates(shape)
    assert bpy.ops.symsurf.detect(method="plane") == {"FINISHED"}
    drawn = shape.symsurf_mirror
    assert drawn.parent == shape and drawn.hide_render
    normal, middle = plane_of()
    assert np.abs((in_scene(drawn) - middle) @ normal).max() < 1e-5
    assert (coordinates(shape) == before).all()
    bpy.ops.symsurf.detect(method="plane")
    assert [each.name for each in shape.children] == ["Mirror of Head"]


def test_symmetries_of_a_turned_box_are_drawn():
    bpy.ops.mesh.primitive_cube_add(location=(3, 1, 2), rotation=(0.3, 0.2, 0.5))
    shape = bpy.context.active_object
    shape.scale = (1, 1.5, 2)
    assert bpy.ops.symsurf.symmetries() == {"FINISHED"}
    planes = [each for each in shape.children if each.name.startswith("Plane")]
    axes = [each for each in shape.children if each.name.startswith("Axis")]
    assert len(planes) == len(axes) == 3 and shape.symsurf_mirror == planes[0]
    middle = np.array((3, 1, 2))
    for line in axes:
        one, other = in_scene(line)
        across = np.cross(other - one, middle - one) / np.linalg.norm(other - one)
        assert np.linalg.norm(across) < 1e-5
    for plane in planes:
        on, *others = in_scene(plane)
        normal = np.cross(others[0] - on, others[-1] - on)
        assert abs((middle - on) @ normal) < 1e-5 * np.linalg.norm(normal)
    bpy.ops.symsurf.detect(method="plane")
    assert [each.name for each in shape.children] == [f"Mirror of {shape.name}"]


@pytest.mark.parametrize("detects_first", [True, False])
def test_align_lays_the_mesh_over_x(detects_first):
    shape, partner = head()
    before = polygons(shape), uv(shape)
    if detects_first:
        bpy.ops.symsurf.detect(method="plane")
    assert bpy.ops.symsurf.align() == {"FINISHED"}
    assert shape.matrix_world == Matrix()
    assert asymmetry_of(coordinates(shape), partner) < ROUNDING
    assert np.ptp(coordinates(shape)[:, 2]) > 4  # the scale of 2 was applied
    assert polygons(shape) == before[0] and (uv(shape) == before[1]).all()
    if detects_first:
        assert np.abs(in_scene(shape.symsurf_mirror)[:, 0]).max() < ROUNDING
        assert np.array_equal(_plane(shape)[0], (1, 0, 0))


def test_align_moves_the_object_alone():
    shape, partner = head()
    before = coordinates(shape)
    bpy.ops.symsurf.detect(method="plane")
    bpy.ops.symsurf.align(move="OBJECT")
    assert (coordinates(shape) == before).all()
    assert asymmetry_of(in_scene(shape), partner) < 2 * ROUNDING
    assert shape.matrix_world.to_scale().x == pytest.approx(2)
    assert np.abs(in_scene(shape.symsurf_mirror)[:, 0]).max() < 1e-5


def test_symmetrize_keeps_order_polygons_and_texture_coordinates():
    shape, partner = head()
    dented(shape)
    before = polygons(shape), uv(shape)
    bpy.ops.symsurf.detect(method="plane")
    bpy.ops.symsurf.symmetrize()
    assert polygons(shape) == before[0] and (uv(shape) == before[1]).all()
    normal, offset = _plane(shape)
    points = in_scene(shape)
    images = points - 2 * (points @ normal + offset)[:, None] * normal
    assert np.abs(images[partner] - points).max() < ROUNDING


def test_symmetrize_moves_what_the_vertex_group_says():
    shape, _ = head()
    dented(shape)
    still = np.arange(100)
    group = shape.vertex_groups.new(name="Soft")
    group.add(list(range(100, len(shape.data.vertices))), 1.0, "REPLACE")
    before = coordinates(shape)
    bpy.ops.symsurf.symmetrize(vertex_group="Soft")
    after = coordinates(shape)
    assert (after[still] == before[still]).all()
    assert (after[100:] != before[100:]).any()


def _plane(shape):
    numbers = json.loads(shape.symsurf_mirror["symsurf_mirror"])["numbers"]
    return np.array(numbers["normal"]), numbers["offset"]


def test_mirrored_triangles_are_exact_and_quadrilaterals_stay():
    shape, _ = head(place=Matrix())
    points = coordinates(shape)
    points[points[:, 0] < 0, 0] *= 1.02  # texture coordinates do not depend on x
    set_coordinates(shape, points)
    _own_plane(shape)
    bpy.ops.symsurf.symmetrize(triangles="mirrored", side="positive")
    new = coordinates(shape)
    assert {tuple(each) for each in new} == {tuple(each) for each in new * np.float32((-1, 1, 1))}
    sizes = np.bincount([len(each) for each in polygons(shape)])
    assert sizes[4] == 40 * 23
    assert not shape.data.validate()
    corners = np.concatenate([np.array(each) for each in polygons(shape)])
    assert np.abs(uv(shape) - uv_of(new[corners])).max() < 1e-6
    assert _is_closed_and_turned_outwards(shape)


@pytest.mark.parametrize("options", [{"triangles": "mirrored"}, {"triangles": "kept"}])
def test_a_mesh_needs_no_texture_coordinates(options):
    shape, _ = head()
    shape.data.uv_layers.remove(shape.data.uv_layers[0])
    assert bpy.ops.symsurf.symmetrize(**options) == {"FINISHED"}
    assert not shape.data.uv_layers


def _own_plane(shape, angle=np.pi / 2):
    """An empty whose local z lies along x: the plane x = 0."""
    empty = bpy.data.objects.new("Plane", None)
    bpy.context.scene.collection.objects.link(empty)
    empty.matrix_world = Matrix.Rotation(angle, 4, "Y")
    shape.symsurf_mirror = empty
    bpy.context.view_layer.update()


def _is_closed_and_turned_outwards(shape):
    edges = {}
    for each in polygons(shape):
        for start, end in zip(each, each[1:] + each[:1]):
            edges[start, end] = edges.get((start, end), 0) + 1
    closed = all(edges.get(edge[::-1]) == count == 1 for edge, count in edges.items())
    volume = 0.0
    points = coordinates(shape).astype(np.float64)
    for each in polygons(shape):
        for second, third in itertools.pairwise(each[1:]):
            volume += np.dot(points[each[0]], np.cross(points[second], points[third])) / 6
    return closed and volume > 0


def test_cut_leaves_a_closed_half():
    shape, _ = head(place=Matrix())
    shape.data.materials.append(bpy.data.materials.new("Skin"))
    _own_plane(shape)
    bpy.ops.symsurf.cut(side="positive")
    points = coordinates(shape)
    assert points[:, 0].min() > -1e-6
    assert _is_closed_and_turned_outwards(shape)
    cap = values(shape, "cut_cap") > 0
    assert cap.any()
    for each, is_cap in zip(polygons(shape), cap):
        assert (np.abs(points[list(each), 0]) < 1e-6).all() == is_cap


def test_complete_adds_the_other_side():
    shape, _ = head(place=Matrix())
    points, faces = coordinates(shape), polygons(shape)
    kept = np.flatnonzero(points[:, 0] > -0.45)
    number = np.full(len(points), -1)
    number[kept] = np.arange(len(kept))
    left = [each for each in faces if (number[list(each)] >= 0).all()]
    mesh = bpy.data.meshes.new("Broken")
    mesh.from_pydata(points[kept].tolist(), [], [number[list(each)].tolist() for each in left])
    set_uv(mesh, points[kept])
    seam = mesh.edges[5]
    seam.use_seam = True
    ends = set(seam.vertices)
    shape.data = mesh
    _own_plane(shape)
    bpy.ops.symsurf.complete(blend=0)
    new = coordinates(shape)
    assert (new[: len(kept)] == points[kept]).all()
    assert polygons(shape)[: len(left)] == [tuple(number[list(each)].tolist()) for each in left]
    assert [
        set(each.vertices)
        for each in shape.data.edges
        if each.use_seam and set(each.vertices) == ends
    ]
    assert np.bincount([len(each) for each in polygons(shape)])[4] > 0.9 * 40 * 23
    missing = points[number < 0]
    distances = np.linalg.norm(new[:, None] - missing[None], axis=2).min(axis=0)
    assert np.quantile(distances, 0.9) < 1e-5
    corners = np.concatenate([np.array(each) for each in polygons(shape)])
    is_image = values(shape, "complete_origin")[corners] == 1
    assert np.abs(uv(shape) - uv_of(new[corners]))[is_image].max() < 1e-5


def test_remesh_gives_partners():
    shape, _ = head(place=Matrix())
    _own_plane(shape)
    bpy.ops.symsurf.remesh(edge_length=0.05)
    partner = values(shape, "remesh_partner").astype(int)
    assert asymmetry_of(coordinates(shape), partner) == 0
    assert uv(shape).min() > 0


def test_asymmetry_becomes_colours_and_attributes():
    shape, _ = head(place=Matrix())
    points = coordinates(shape)
    dent = 300
    points[dent] *= 1.05
    set_coordinates(shape, points)
    _own_plane(shape)
    bpy.ops.symsurf.asymmetry()
    assert (coordinates(shape) == points).all()
    distance = values(shape, "asymmetry_distance")
    assert np.quantile(distance, 0.9) < 1e-6
    assert distance[dent] > 0.02
    colours = values(shape, "Mirror asymmetry", "color", 4)
    assert shape.data.color_attributes.active_color_name == "Mirror asymmetry"
    grey = np.ptp(colours[:, :3], axis=1) < 0.05
    assert grey.mean() > 0.9 and not grey[dent]


def test_straighten_unbends():
    shape, _ = head(place=Matrix())
    points = coordinates(shape).astype(np.float64)
    angle, radius = points[:, 2] / 5, 5 + points[:, 0]  # the mirror x = 0 wound about a cylinder
    bent = np.stack([radius * np.cos(angle), points[:, 1], radius * np.sin(angle)], -1)
    set_coordinates(shape, bent)
    bpy.ops.symsurf.detect(method="cylinder")
    curved = shape.symsurf_mirror
    bpy.ops.symsurf.straighten()
    assert shape.symsurf_mirror != curved
    straight = coordinates(shape)
    lengths = [
        np.linalg.norm(each[None] - each[:, None], axis=2) for each in (straight[::9], points[::9])
    ]
    assert np.abs(lengths[0] - lengths[1]).max() < 0.05
    assert np.abs(in_scene(shape.symsurf_mirror)).max() < 20
    shape.symsurf_mirror = curved
    bpy.ops.symsurf.straighten(back=True)
    assert np.abs(coordinates(shape) - bent).max() < 1e-3


def test_correspondences_are_the_known_partners():
    shape, partner = head()
    bpy.ops.symsurf.correspondences()
    assert (values(shape, "correspondences_index") == partner).all()


class TestTransforms:
    def test_mirror_goes_with_its_shape(self):
        shape, partner = head()
        bpy.ops.symsurf.detect(method="plane")
        shape.matrix_world = Matrix.Translation((5, 1, 1)) @ Matrix.Rotation(1, 4, "Z")
        dented(shape)
        bpy.ops.symsurf.symmetrize()
        assert asymmetry_of(in_scene(shape), partner, shape.matrix_world) < 1e-5

    def test_mirror_moved_by_hand_is_that_mirror(self):
        shape, _ = head(place=Matrix())
        bpy.ops.symsurf.detect(method="plane")
        shape.symsurf_mirror.location = (0.1, 0, 0)
        bpy.ops.symsurf.cut(side="positive")
        assert coordinates(shape)[:, 0].min() == pytest.approx(0.1, abs=1e-5)

    def test_uneven_scale_is_seen(self):
        place = Matrix.LocRotScale(Vector((1, 2, 3)), None, Vector((1, 2, 0.5)))
        shape, partner = head(place=place)
        dented(shape)
        bpy.ops.symsurf.detect(method="plane")
        bpy.ops.symsurf.symmetrize()
        normal, offset = _plane(shape)
        points = in_scene(shape)
        images = points - 2 * (points @ normal + offset)[:, None] * normal
        assert np.abs(images[partner] - points).max() < ROUNDING

    def test_mirrored_scale_is_refused(self):
        head(place=Matrix.Scale(-1, 4))
        with pytest.raises(RuntimeError, match="apply it first"):
            bpy.ops.symsurf.align()

    def test_parents_count(self):
        parent = bpy.data.objects.new("Parent", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.matrix_world = Matrix.Rotation(0.7, 4, "X") @ Matrix.Scale(3, 4)
        shape, partner = head()
        shape.parent = parent
        bpy.ops.symsurf.align()
        assert np.abs(np.array(shape.matrix_world) - np.eye(4)).max() < 1e-6
        assert asymmetry_of(coordinates(shape), partner) < 1e-5


class TestFailures:
    def test_no_symmetry_leaves_the_mesh(self):
        shape, _ = head()
        x, y, z = coordinates(shape).T
        lumps = 0.4 * np.sin(3 * x + 1) * np.cos(2 * y - z) + 0.3 * np.sin(4 * z - 2 * x + y)
        set_coordinates(shape, coordinates(shape) * (1 + lumps[:, None]))
        before = coordinates(shape)
        with pytest.raises(RuntimeError, match="no mirror"):
            bpy.ops.symsurf.symmetrize()
        assert (coordinates(shape) == before).all()

    def test_shape_keys_keep_meshes_from_other_vertices(self):
        shape, _ = head()
        shape.shape_key_add(name="Basis")
        with pytest.raises(RuntimeError, match="shape keys"):
            bpy.ops.symsurf.cut()

    def test_needs_a_mesh(self):
        bpy.context.view_layer.objects.active = None
        assert not bpy.ops.symsurf.align.poll()

    def test_edit_mode_is_refused(self):
        head()
        bpy.ops.object.mode_set(mode="EDIT")
        assert not bpy.ops.symsurf.align.poll()

    def test_bad_parameter_is_clamped_to_what_is_allowed(self):
        limits = bpy.ops.symsurf.symmetrize.get_rna_type().properties["max_angle"]
        assert (limits.hard_min, limits.hard_max) == (0, 90)


@pytest.mark.parametrize("name", ["align", "symmetrize", "cut", "complete", "asymmetry"])
def test_undo_is_one_step(name):
    shape, _ = head()
    dented(shape)
    before = coordinates(shape), polygons(shape), uv(shape), shape.matrix_world.copy()
    bpy.ops.ed.undo_push(message="start")
    assert getattr(bpy.ops.symsurf, name)("EXEC_DEFAULT", True) == {"FINISHED"}
    bpy.ops.ed.undo()
    shape = bpy.data.objects["Head"]  # what was there before is another object to Python
    after = coordinates(shape), polygons(shape), uv(shape), shape.matrix_world
    assert (before[0] == after[0]).all() and before[1] == after[1]
    assert (before[2] == after[2]).all() and before[3] == after[3]


def test_place_is_not_the_identity():
    assert PLACE != Matrix()
