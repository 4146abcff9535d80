"""What the operations leave in the document is what is true of the shape."""

from __future__ import annotations

import numpy as np
import pymeshlab
import pytest
from shapes import Shape, box, lump, lump_cloud

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

MEASURING = ("asymmetry", "correspondences")
GREY = 128 / 255


def filter_of(operation: str) -> str:
    described = symsurf.operations()[operation]
    moves = described.moves_points or described.adds_points or described.carries_values
    return ("apply_" if moves else "compute_") + described.title.lower().replace(" ", "_")


def add_plane(mesh_set: pymeshlab.MeshSet, shape: Shape, shift: float = 0) -> int:
    """A layer of a square on the plane of the shape, shifted along its normal; returns its number."""
    across = np.linalg.svd(shape.normal[None])[2][1:]
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ across * shape.diagonal
    corners += (shift - shape.offset) * shape.normal
    mesh_set.add_mesh(pymeshlab.Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)])), "square")
    number = mesh_set.current_mesh_id()
    mesh_set.set_current_mesh(0)
    return number


def apply(mesh_set: pymeshlab.MeshSet, operation: str, **parameters) -> dict:
    return mesh_set.apply_filter(filter_of(operation), **parameters)


def attribute(mesh: pymeshlab.Mesh, array: symsurf.PointArray) -> np.ndarray:
    if array.components == 3:
        return mesh.vertex_custom_point_attribute_matrix(array.name)
    return mesh.vertex_custom_scalar_attribute_array(array.name)


def bumped(height: float) -> tuple[Shape, np.ndarray]:
    """A lump with a smooth bump, as a share of its diagonal, on one side; how high it is where."""
    shape = lump(around=128, up=64)
    top = np.argmax(shape.points @ shape.normal)
    distance = np.linalg.norm(shape.points - shape.points[top], axis=1) / shape.diagonal
    rise = height * shape.diagonal * np.exp(-((distance / 0.05) ** 2))
    rise[distance > 0.2] = 0
    shape.points = shape.points + rise[:, None] * shape.normal
    return shape, rise


def test_landmarks_count_as_pairs_do():
    balls = pymeshlab.MeshSet()
    balls.create_sphere(subdiv=3)
    ball = balls.current_mesh()
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]  # no vertex has a twin
    points = ball.vertex_matrix() @ turn * (1, 0.8, 1.2)
    points += 0.05 * np.clip(points[:, :1], 0, None) * np.cross(points, (1, 0, 0))
    pairs = np.array([[3, 50], [120, 7]])
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(points, ball.face_matrix()))
    square = np.array([(0, -1, -1), (0, 1, -1), (0, 1, 1), (0, -1, 1)], dtype=float)
    mesh_set.add_mesh(pymeshlab.Mesh(square, np.array([(0, 1, 2), (0, 2, 3)])))
    mesh_set.add_mesh(pymeshlab.Mesh(points[pairs.ravel()]))
    mesh_set.set_current_mesh(0)
    options = {"mirror_layer": 1, "pairing": "homologous"}
    deviation = pymeshlab.PureValue(0.01)
    apply(mesh_set, "asymmetry", **options, landmarks_layer=2, landmarks_deviation=deviation)
    found = mesh_set.current_mesh().vertex_custom_point_attribute_matrix("vector")
    expected, without = (
        symsurf.asymmetry(
            symsurf.Shape(points, ball.face_matrix()), "x=0", pairing="homologous", **given
        ).vector
        for given in ({"pairs": pairs, "pairs_sd": 0.01}, {})
    )
    assert abs(expected - without).max() > 1e-2
    np.testing.assert_allclose(found, expected, atol=1e-4)


def images(points: np.ndarray, normal: np.ndarray, offset: float) -> np.ndarray:
    return points - 2 * (points @ normal + offset)[:, None] * normal


def off_the_shape(points: np.ndarray, others: np.ndarray) -> float:
    """How far the farthest of the points is from the closest of the others."""
    return max(np.linalg.norm(others - p, axis=1).min() for p in points)


def volume(points: np.ndarray, faces: np.ndarray) -> float:
    """Between the faces and the centroid of the points, faces that look inwards negative."""
    a, b, c = (points - points.mean(axis=0))[faces].swapaxes(0, 1)
    return (np.cross(a, b) * c).sum() / 6


@pytest.mark.parametrize("operation", MEASURING)
@pytest.mark.parametrize("make", (lump, lump_cloud))
def test_vertices_get_the_arrays_of_python(operation, make):
    shape = make(1)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane")
    returned = apply(mesh_set, operation)
    mirror = symsurf.detect(shape.points, "plane", faces=shape.faces)
    expected = getattr(symsurf, operation)(shape.points, mirror, faces=shape.faces)
    layer = mesh_set.current_mesh()
    assert layer.label() == "shape" and mesh_set[returned["mirror_layer"]].label() == "Mirror"
    assert np.array_equal(layer.vertex_matrix(), shape.points)
    arrays = {a.name: a for a in symsurf.operations()[operation].arrays}
    for name, values in expected.arrays.items():
        near = {"rtol": 0, "atol": 1e-9 * shape.diagonal, "equal_nan": True}
        assert np.allclose(attribute(layer, arrays[name]), values, **near), name
    assert returned.keys() == expected.statistics.keys() | {"mirror_layer"}
    for name, value in expected.statistics.items():
        assert returned[name] == pytest.approx(value, abs=1e-9 * shape.diagonal), name


def test_a_bump_is_seen_with_its_height_and_nothing_else():
    height = 0.02
    shape, rise = bumped(height)
    mesh_set = shape.mesh_set()
    returned = apply(mesh_set, "asymmetry", mirror_layer=add_plane(mesh_set, shape))
    layer = mesh_set.current_mesh()
    signed, top = layer.vertex_scalar_array(), height * shape.diagonal
    assert returned["maximum"] == pytest.approx(top, rel=0.02)
    # Outwards too far on one side is inwards too far on the other.
    assert -signed.min() == pytest.approx(top, rel=0.1)
    assert signed.max() == pytest.approx(top, rel=0.1)
    mirrored = images(shape.points, shape.normal, shape.offset)
    across = rise[[np.linalg.norm(shape.points - p, axis=1).argmin() for p in mirrored]]
    away = (rise == 0) & (across < 1e-4 * shape.diagonal)
    assert away.mean() > 0.5 and np.abs(signed[away]).max() < 1e-3 * shape.diagonal
    colours = layer.vertex_color_matrix()[:, :3]
    assert colours[signed.argmin()] == pytest.approx((0, 0, 1), abs=0.01)  # blue: too far out
    assert colours[signed.argmax()] == pytest.approx((1, 0, 0), abs=0.2)
    even = np.abs(signed) < 1e-9 * shape.diagonal
    assert even.any() and np.allclose(colours[even], (0, 1, 0), atol=0.02)


def test_vertices_without_counterpart_are_grey():
    shape = lump(2)
    keep = shape.points @ shape.normal + shape.offset < 0.2 * shape.diagonal
    number = np.cumsum(keep) - 1
    shape.points, shape.faces = (
        shape.points[keep],
        number[shape.faces[keep[shape.faces].all(axis=1)]],
    )
    mesh_set = shape.mesh_set()
    returned = apply(mesh_set, "asymmetry", mirror_layer=add_plane(mesh_set, shape))
    layer = mesh_set.current_mesh()
    matched = layer.vertex_custom_scalar_attribute_array("matched") == 1
    assert 0 < returned["matched_share"] == matched.mean() < 1
    colours = layer.vertex_color_matrix()[:, :3]
    assert np.allclose(colours[~matched], GREY, atol=0.01)
    assert not (np.ptp(colours[matched], axis=1) == 0).any()
    assert not layer.vertex_scalar_array()[~matched].any()
    assert np.isnan(layer.vertex_custom_scalar_attribute_array("distance")[~matched]).all()


def test_correspondences_are_blue_where_they_are_sure():
    shape = lump(3)
    mesh_set = shape.mesh_set()
    returned = apply(mesh_set, "correspondences", mirror_layer=add_plane(mesh_set, shape))
    layer = mesh_set.current_mesh()
    index = layer.vertex_custom_scalar_attribute_array("index").astype(int)
    assert returned["paired_share"] == 1 and np.array_equal(index[index], np.arange(len(index)))
    near = {"rtol": 0, "atol": 1e-9 * shape.diagonal}
    mirrored = images(shape.points, shape.normal, shape.offset)
    assert np.allclose(mirrored, shape.points[index], **near)
    assert np.allclose(layer.vertex_color_matrix()[:, :3], (0, 0, 1), atol=0.02)


def test_illumination_is_that_of_the_lights_image():
    shape = lump(3)
    mesh_set = shape.mesh_set()
    plane = add_plane(mesh_set, shape, shift=-2 * shape.diagonal)
    light = shape.points.mean(axis=0) - 0.5 * shape.diagonal * shape.normal
    returned = apply(mesh_set, "illuminate", mirror_layer=plane, light=light)
    layer = mesh_set.current_mesh()
    offset = shape.offset + 2 * shape.diagonal  # of the plane that add_plane has shifted
    ways = shape.points - images(light[None], shape.normal, offset)
    far = np.linalg.norm(ways, axis=1)
    lit = symsurf.illuminate(
        shape.points, symsurf.Plane(shape.normal, offset), faces=shape.faces, light=light
    )
    assert returned["lit_share"] == 1 and (lit.irradiance <= 1.000001 / far**2).all()
    quality = layer.vertex_scalar_array()
    assert np.allclose(quality, lit.irradiance, rtol=1e-5)
    colours = layer.vertex_color_matrix()[:, :3]
    assert colours[quality.argmax()] == pytest.approx((1, 0, 0), abs=0.01)
    assert colours[quality.argmin()] == pytest.approx((0, 0, 1), abs=0.2)


@pytest.mark.parametrize("axis", (0, 1, 2))
@pytest.mark.parametrize("make", (lump, lump_cloud))
def test_alignment_lays_the_plane_on_a_coordinate_plane(make, axis):
    shape = make(4)
    mesh_set = shape.mesh_set()
    returned = apply(mesh_set, "align", axis="xyz"[axis])
    layer, matrix = mesh_set.current_mesh(), returned["matrix"]
    points, atol = layer.vertex_matrix(), 1e-9 * shape.diagonal
    assert np.allclose(points, shape.points @ matrix[:3, :3].T + matrix[:3, 3], atol=atol)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)
    assert off_the_shape(points * (1 - 2 * np.eye(3)[axis]), points) < atol
    # The mirror goes along, so that the layer is aligned over it already.
    mirror = mesh_set[returned["mirror_layer"]]
    assert mirror.label() == "Mirror" and np.abs(mirror.vertex_matrix()[:, axis]).max() < atol
    again = apply(mesh_set, "align", axis="xyz"[axis])
    assert again["matrix"] == pytest.approx(np.eye(4), abs=1e-9) and len(mesh_set) == 2


def test_all_that_was_found_goes_along_with_an_aligned_layer():
    shape = box(5)
    mesh_set = shape.mesh_set()
    mesh_set.apply_filter("compute_mirror_plane", show_candidates=True)
    before = {m.id(): m.vertex_matrix() for m in mesh_set}
    matrix = apply(mesh_set, "align")["matrix"]
    assert len(before) == len(mesh_set) == 5
    for layer in mesh_set:
        moved = before[layer.id()] @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.allclose(layer.vertex_matrix(), moved, rtol=0, atol=1e-9 * shape.diagonal)
    # A candidate serves as a mirror where it lies now.
    for candidate in [m.id() for m in mesh_set if m.label().startswith("Candidate")]:
        returned = apply(mesh_set, "asymmetry", mirror_layer=candidate)
        assert returned["maximum"] < 1e-9 * shape.diagonal


def test_normals_of_an_aligned_cloud_turn_with_it():
    shape = lump_cloud(6)
    normals = shape.points / np.linalg.norm(shape.points, axis=1)[:, None]
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(shape.points, v_normals_matrix=normals))
    matrix = apply(mesh_set, "align")["matrix"]
    turned = mesh_set.current_mesh().vertex_normal_matrix()
    assert turned == pytest.approx(normals @ matrix[:3, :3].T, abs=1e-9)
    apply(mesh_set, "symmetrize")
    assert not mesh_set.current_mesh().vertex_normal_matrix().any()


def test_a_curved_mirror_is_laid_flat_and_bent_back():
    radius, rng = 10, np.random.default_rng(9)
    outside = rng.normal(size=(400, 3)) * (2, 1.5, 0) + (0, 0, radius)
    outside *= ((radius + 0.5 + rng.random(400)) / np.linalg.norm(outside, axis=1))[:, None]
    inside = outside * (2 * radius / np.linalg.norm(outside, axis=1) - 1)[:, None]
    points = np.vstack([outside, inside]) + (1, 2, 3)
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(points), "cap")
    found = mesh_set.apply_filter("compute_mirror_sphere")
    near = {"rtol": 0, "atol": 1e-6}
    assert found["radius"] == pytest.approx(radius, abs=1e-6)

    returned = apply(mesh_set, "straighten")
    assert returned["mirror_layer"] == found["mirror_layer"]
    flat, layers = mesh_set.current_mesh().vertex_matrix(), len(mesh_set)
    assert returned["unplaced_points"] == 0
    # The sphere maps the points onto each other, so the plane does once they are straightened.
    normal, offset = returned["normal"], returned["offset"]
    assert np.allclose(images(flat[:400], normal, offset), flat[400:], **near)
    plane = mesh_set[returned["mirror_layer"]].vertex_matrix()
    assert np.allclose(plane @ normal + offset, 0, **near)
    assert apply(mesh_set, "asymmetry")["maximum"] < 1e-6

    # Over its plane nothing moves; back it goes over the sphere that the layer was.
    apply(mesh_set, "straighten")
    assert np.allclose(mesh_set.current_mesh().vertex_matrix(), flat, **near)
    assert apply(mesh_set, "straighten", back=True)["mirror_layer"] == found["mirror_layer"]
    assert np.allclose(mesh_set.current_mesh().vertex_matrix(), points, **near)
    sphere = mesh_set[found["mirror_layer"]].vertex_matrix() - found["centre"]
    assert np.allclose(np.linalg.norm(sphere, axis=1), radius, **near)
    assert apply(mesh_set, "asymmetry")["maximum"] < 1e-6 and len(mesh_set) == layers


def test_symmetrization_is_exact_and_keeps_what_vertices_have():
    shape, _ = bumped(0.005)
    rng = np.random.default_rng(7)
    given = {
        "v_color_matrix": rng.random((len(shape.points), 4)),
        "v_scalar_array": rng.random(len(shape.points)),
        "w_tex_coords_matrix": rng.random((3 * len(shape.faces), 2)),
    }
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(shape.points, shape.faces, **given), "shape")
    mesh_set.apply_filter("compute_normal_per_vertex")
    before, plane = mesh_set.current_mesh(), add_plane(mesh_set, shape)
    colours, quality = before.vertex_color_matrix(), before.vertex_scalar_array()
    texture, normals = before.wedge_tex_coord_matrix(), before.vertex_normal_matrix()
    returned = apply(mesh_set, "symmetrize", mirror_layer=plane)
    layer = mesh_set.current_mesh()
    points = layer.vertex_matrix()
    assert returned["paired_share"] == 1 and not np.allclose(points, shape.points)
    mirrored = images(points, shape.normal, shape.offset)
    assert off_the_shape(mirrored, points) < 1e-9 * shape.diagonal
    assert np.array_equal(layer.face_matrix(), shape.faces)
    assert np.array_equal(layer.vertex_color_matrix(), colours)
    assert np.array_equal(layer.vertex_scalar_array(), quality)
    assert np.array_equal(layer.wedge_tex_coord_matrix(), texture)
    assert not np.allclose(layer.vertex_normal_matrix(), normals)


def test_only_what_is_selected_is_symmetrized():
    shape, rise = bumped(0.02)
    mesh_set = shape.mesh_set()
    plane = add_plane(mesh_set, shape)
    apply(mesh_set, "asymmetry", mirror_layer=plane)
    mesh_set.apply_filter("compute_selection_by_condition_per_vertex", condselect="q < -0.001")
    selected = mesh_set.current_mesh().vertex_selection_array()
    apply(mesh_set, "symmetrize", mirror_layer=plane, only_selected=True)
    moved = (mesh_set.current_mesh().vertex_matrix() != shape.points).any(axis=1)
    assert 0 < selected.mean() < 0.5 and moved.any() and not (moved & ~selected).any()
    assert np.array_equal(mesh_set.current_mesh().vertex_selection_array(), selected)
    assert rise[moved].min() > 0


def test_quality_says_how_far_each_vertex_moves():
    shape, _ = bumped(0.02)
    share = np.random.default_rng(8).random(len(shape.points))
    symmetrized = []
    for quality in (np.ones_like(share), share):
        mesh_set = pymeshlab.MeshSet()
        mesh = pymeshlab.Mesh(shape.points, shape.faces, v_scalar_array=quality)
        mesh_set.add_mesh(mesh)
        plane = add_plane(mesh_set, shape)
        apply(mesh_set, "symmetrize", mirror_layer=plane, weigh_by_quality=True)
        symmetrized.append(mesh_set.current_mesh().vertex_matrix() - shape.points)
    full, part = symmetrized
    assert part == pytest.approx(share[:, None] * full, abs=1e-12 * shape.diagonal)
    assert np.abs(full).max() > 0.005 * shape.diagonal


class Cut(Shape):
    """A lump without a patch of its far side, with all that MeshLab's vertices and faces can have."""

    def __init__(self, seed: int):
        whole = lump(seed, around=96, up=48)
        side = whole.points @ whole.normal + whole.offset
        middle = whole.points[np.argmax(side)]
        keep = np.linalg.norm(whole.points - middle, axis=1) > 0.15 * whole.diagonal
        number = np.cumsum(keep) - 1
        self.whole = whole
        self.points = whole.points[keep]
        self.faces = number[whole.faces[keep[whole.faces].all(axis=1)]]
        self.normal, self.offset, self.diagonal = whole.normal, whole.offset, whole.diagonal
        rng = np.random.default_rng(seed)
        self.colours = rng.random((len(self.points), 4)).round(1)
        self.texture = rng.random((len(self.faces), 3, 2))

    def mesh_set(self) -> pymeshlab.MeshSet:
        mesh_set = pymeshlab.MeshSet()
        mesh = pymeshlab.Mesh(
            self.points,
            self.faces,
            v_color_matrix=self.colours,
            v_scalar_array=np.arange(len(self.points), dtype=float),
            w_tex_coords_matrix=self.texture.reshape(-1, 2),
        )
        mesh.add_vertex_custom_scalar_attribute(np.arange(len(self.points)) / 2, "half")
        mesh_set.add_mesh(mesh, "shape")
        return mesh_set


def test_completion_adds_what_the_uncut_mesh_has():
    shape = Cut(10)
    mesh_set = shape.mesh_set()
    plane = add_plane(mesh_set, shape)
    returned = apply(mesh_set, "complete", mirror_layer=plane)
    layer, old = mesh_set.current_mesh(), len(shape.points)
    points, faces = layer.vertex_matrix(), layer.face_matrix()
    assert layer.label() == "shape" and len(points) - old == returned["added_points"] > 50
    assert np.array_equal(points[:old], shape.points)
    assert np.array_equal(faces[: len(shape.faces)], shape.faces)
    assert off_the_shape(points[old:], shape.whole.points) < 1e-9 * shape.diagonal
    assert off_the_shape(shape.whole.points, points) < 1e-9 * shape.diagonal
    origin = layer.vertex_custom_scalar_attribute_array("origin")
    assert not origin[:old].any() and origin[old:].all()
    # What was added is what is selected, and closes the hole without turning a face round.
    assert np.array_equal(
        np.flatnonzero(layer.vertex_selection_array()), np.arange(old, len(points))
    )
    added = np.arange(len(shape.faces), len(faces))
    assert np.array_equal(np.flatnonzero(layer.face_selection_array()), added)
    assert volume(points, faces) == pytest.approx(
        volume(shape.whole.points, shape.whole.faces), rel=1e-3
    )
    topology = mesh_set.apply_filter("get_topological_measures")
    assert topology["number_holes"] == 2  # at the lump's poles
    # Done once there is nothing left to do.
    assert apply(mesh_set, "complete", mirror_layer=plane)["added_points"] == 0


def test_what_completion_adds_has_the_attributes_of_its_sources():
    shape = Cut(11)
    mesh_set = shape.mesh_set()
    apply(
        mesh_set, "complete", mirror_layer=add_plane(mesh_set, shape), blend=pymeshlab.PureValue(0)
    )
    layer, old = mesh_set.current_mesh(), len(shape.points)
    points, faces = layer.vertex_matrix(), layer.face_matrix()
    # Quality numbered the vertices: each added one is the image of the one whose number it has.
    source = layer.vertex_scalar_array().astype(int)
    assert np.array_equal(source[:old], np.arange(old))
    mirrored = images(shape.points[source[old:]], shape.normal, shape.offset)
    assert np.allclose(points[old:], mirrored, rtol=0, atol=1e-9 * shape.diagonal)
    half = layer.vertex_custom_scalar_attribute_array("half")
    assert np.array_equal(half, source / 2)
    untouched = shape.mesh_set()
    colours = untouched.current_mesh().vertex_color_matrix()
    assert np.array_equal(layer.vertex_color_matrix(), colours[source])
    # Images of faces have the texture of their corners, which run the other way round.
    texture = layer.wedge_tex_coord_matrix().reshape(-1, 3, 2)
    of_corners = {
        frozenset(face): dict(zip(face, corner)) for face, corner in zip(shape.faces, texture)
    }
    is_image = (faces >= old).all(axis=1)
    checked = 0
    for face, corner in zip(source[faces[is_image]], texture[is_image]):
        if frozenset(face) in of_corners:
            expected = of_corners[frozenset(face)]
            assert all(np.array_equal(expected[i], uv) for i, uv in zip(face, corner))
            checked += 1
    assert checked > 50


def test_mirrored_triangles_have_what_lies_between_their_parents():
    shape = lump(15)
    at = lambda points: points[..., :2] / shape.diagonal
    mesh_set = pymeshlab.MeshSet()
    mesh = pymeshlab.Mesh(
        shape.points, shape.faces, w_tex_coords_matrix=at(shape.points[shape.faces]).reshape(-1, 2)
    )
    mesh.add_vertex_custom_scalar_attribute(np.arange(len(shape.points)), "number")
    mesh_set.add_mesh(mesh, "shape")
    plane = add_plane(mesh_set, shape, shift=0.013 * shape.diagonal)
    apply(mesh_set, "symmetrize", mirror_layer=plane, triangles="mirrored", side="positive")
    layer = mesh_set.current_mesh()
    points, faces = layer.vertex_matrix(), layer.face_matrix()
    offset = shape.offset - 0.013 * shape.diagonal
    partner = layer.vertex_custom_scalar_attribute_array("partner").astype(int)
    mirrored = images(points, shape.normal, offset)
    assert np.allclose(points[partner], mirrored, rtol=0, atol=1e-9 * shape.diagonal)
    number = layer.vertex_custom_scalar_attribute_array("number").astype(int)
    side = points @ shape.normal + offset
    # The side that was kept is the one whose points are those of the shape.
    same = np.abs(shape.points[number] - points).max(axis=1) < 1e-9 * shape.diagonal
    kept = np.sign(side[same & (abs(side) > 0.05 * shape.diagonal)])
    assert len(kept) > 50 and (kept == kept[0]).all()
    own = np.where((side * kept[0] < 0)[:, None], mirrored, points)
    texture = layer.wedge_tex_coord_matrix().reshape(-1, 3, 2)
    assert np.allclose(texture, at(own[faces]), rtol=0, atol=1e-6)


def test_a_cloud_is_completed_too():
    cut = Cut(12)
    mesh_set = pymeshlab.MeshSet()
    mesh_set.add_mesh(pymeshlab.Mesh(cut.points), "shape")
    plane = add_plane(mesh_set, cut)
    returned = apply(mesh_set, "complete", mirror_layer=plane, blend=pymeshlab.PureValue(0))
    layer, old = mesh_set.current_mesh(), len(cut.points)
    points = layer.vertex_matrix()
    assert np.array_equal(points[:old], cut.points) and returned["added_points"] > 50
    assert off_the_shape(points[old:], cut.whole.points) < 1e-9 * cut.diagonal
    assert layer.vertex_selection_array().sum() == returned["added_points"]


def test_a_cut_selects_the_faces_that_close_it():
    shape = lump(16)
    mesh_set = shape.mesh_set()
    plane = add_plane(mesh_set, shape, shift=0.02 * shape.diagonal)
    returned = apply(mesh_set, "cut", mirror_layer=plane, side="positive")
    layer = mesh_set.current_mesh()
    points, faces = layer.vertex_matrix(), layer.face_matrix()
    offset = shape.offset - 0.02 * shape.diagonal
    side = points @ shape.normal + offset
    assert np.ptp(np.sign(side[np.abs(side) > 1e-6 * shape.diagonal])) == 0  # all on one
    is_cap = layer.face_selection_array()
    assert is_cap.sum() == returned["cap_faces"] > 10
    assert np.abs(side[faces[is_cap]]).max() < 1e-9 * shape.diagonal


def test_what_vertices_have_is_carried():
    shape = lump(17)
    mesh_set = pymeshlab.MeshSet()
    side = shape.points @ shape.normal + shape.offset
    colours = np.ones((len(side), 4))
    colours[:, 0] = side > 0
    mesh = pymeshlab.Mesh(
        shape.points, shape.faces, v_color_matrix=colours, v_scalar_array=np.maximum(side, 0)
    )
    mesh.add_vertex_custom_scalar_attribute(side, "side")
    mesh_set.add_mesh(mesh, "shape")
    plane = add_plane(mesh_set, shape)
    returned = apply(mesh_set, "transfer", mirror_layer=plane, side="average")
    layer = mesh_set.current_mesh()
    assert returned["failed_points"] == 0 and np.array_equal(layer.vertex_matrix(), shape.points)
    off = np.abs(side) > 1e-6 * shape.diagonal
    even = layer.vertex_custom_scalar_attribute_array("side")
    assert np.allclose(even, 0, rtol=0, atol=1e-9 * shape.diagonal)
    assert np.allclose(
        layer.vertex_scalar_array()[off], np.abs(side[off]) / 2, atol=1e-9 * shape.diagonal
    )
    assert np.allclose(layer.vertex_color_matrix()[off, 0], 0.5, atol=0.01)
