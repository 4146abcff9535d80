"""Vectors, normals, tensors and rotations go along where points move."""

import warnings

import numpy as np
import pytest
import pyvista
from symmetric_shapes import random_rotation
from symsurf._core import AttributeTransform
from vtk_data import error_of

import symsurf
from symsurf.reflection import carry_over
from symsurf.shapes.kinds import turned
from symsurf.vtk import operations as filters


def rotation(seed):
    return random_rotation(np.random.default_rng(seed))


TURN = rotation(2)
PLANE = symsurf.Plane(TURN[:, 0], 0.1)
MIRRORS = {
    "plane": PLANE,
    "oblique plane": symsurf.ObliquePlane(TURN[:, 0], 0.1, TURN @ (1, 0.3, 0.2)),
    "sphere": symsurf.Sphere(-4 * TURN[:, 0], 4.1),
    "cylinder": symsurf.Cylinder(-4 * TURN[:, 0], TURN[:, 1], 4.1),
}
DIRECTED = {"vector": 3, "normal": 3, "tensor": 6, "quaternion": 4, "harmonics": 45}


def drawn(kind, count=200):
    values = np.random.default_rng(0).normal(size=(count, DIRECTED[kind]))
    return values / np.linalg.norm(values, axis=1, keepdims=True) if kind == "normal" else values


def body(count=200):
    return np.random.default_rng(1).normal(size=(count, 3)) * (1, 0.8, 0.6)


def matrix_of(tensors):
    xx, yy, zz, xy, yz, xz = tensors.T
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)


@pytest.mark.parametrize("kind", DIRECTED)
@pytest.mark.parametrize("mirror", MIRRORS.values(), ids=MIRRORS)
def test_reflected_twice_is_itself(mirror, kind):
    if kind in ("quaternion", "harmonics") and mirror.kind == "oblique plane":
        pytest.skip("the closest orthogonal matrix of a shear is not its own inverse")
    points, given = body(), drawn(kind)
    images = mirror.reflect(points)
    once = carry_over(mirror, points)(given, kind, "given")
    twice = carry_over(mirror, images)(once, kind, "once")
    assert np.abs(once - given).max() > 0.1
    np.testing.assert_allclose(twice, given, atol=1e-9)


@pytest.mark.parametrize("mirror", MIRRORS.values(), ids=MIRRORS)
def test_directions_are_those_of_curves_and_surfaces_through_the_points(mirror):
    """Short steps along a vector lead to steps along its image; normals stay perpendicular to the
    tangents; a tensor v v^T is that of the image of v."""
    points, along = body(), drawn("vector")
    carried = AttributeTransform(mirror, points)
    image = carried(along, "vector")
    step = 1e-5
    chord = (mirror.reflect(points + step * along) - mirror.reflect(points - step * along)) / step
    np.testing.assert_allclose(image, chord / 2, atol=1e-8)
    tangent = drawn("normal")[::-1]
    normal = np.cross(along, tangent)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    across = carried(normal, "normal")
    np.testing.assert_allclose((across * image).sum(axis=1), 0, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(across, axis=1), 1)
    square = np.einsum("ni,nj->nij", along, along).reshape(-1, 9)
    wanted = np.einsum("ni,nj->nij", image, image).reshape(-1, 9)
    np.testing.assert_allclose(carried(square, "tensor"), wanted, atol=1e-9)


@pytest.mark.parametrize("matrix", [rotation(3), -rotation(4)], ids=["rotation", "reflection"])
def test_rotations_and_harmonics_turn_with_what_they_describe(matrix):
    quaternions = drawn("quaternion")
    made = turned(quaternions, "quaternion", matrix)
    last = np.diag((np.sign(np.linalg.det(matrix)), 1, 1))
    np.testing.assert_allclose(frames(made), matrix @ frames(quaternions) @ last, atol=1e-12)
    # A lobe, the cube of the cosine with a direction, is that with the turned direction.
    lobe = drawn("normal", 1)[0]
    before, after = (lobe_harmonics(d) for d in (lobe, matrix @ lobe))
    np.testing.assert_allclose(turned(before, "harmonics", matrix), after, atol=1e-12)
    assert np.abs(before - after).max() > 0.1


def frames(quaternions):
    w, x, y, z = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def lobe_harmonics(lobe):
    """Coefficients (1, 45) of t + t^2 + t^3, t the cosine with the lobe."""
    d = np.random.default_rng(5).normal(size=(400, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    cosine = d @ lobe
    found = np.linalg.lstsq(
        np.column_stack(lobe_basis(d.T)), cosine + cosine**2 + cosine**3, rcond=None
    )[0]
    return np.tile(found[1:], 3)[None]


def lobe_basis(d):
    """(16, ...) harmonics of unit vectors (3, ...) up to degree 3, by the polynomials of the splats'
    renderer."""
    x, y, z = d
    xx, yy, zz = x * x, y * y, z * z
    return [
        np.ones_like(x),
        -0.4886025119029199 * y,
        0.4886025119029199 * z,
        -0.4886025119029199 * x,
        1.0925484305920792 * x * y,
        -1.0925484305920792 * y * z,
        0.31539156525252005 * (2 * zz - xx - yy),
        -1.0925484305920792 * x * z,
        0.5462742152960396 * (xx - yy),
        -0.5900435899266435 * y * (3 * xx - yy),
        2.890611442640554 * x * y * z,
        -0.4570457994644658 * y * (4 * zz - xx - yy),
        0.3731763325901154 * z * (2 * zz - 3 * xx - 3 * yy),
        -0.4570457994644658 * x * (4 * zz - xx - yy),
        1.445305721320277 * z * (xx - yy),
        -0.5900435899266435 * x * (xx - 3 * yy),
    ]


@pytest.fixture(scope="module")
def mesh():
    """An asymmetric ball, without texture, with a vector and a tensor of each point."""
    sphere = pyvista.Sphere(theta_resolution=24, phi_resolution=16)
    points = np.asarray(sphere.points, dtype=float) * (1, 1.3, 0.8) @ TURN.T
    made = pyvista.PolyData(points, sphere.faces)
    made.point_data["wind"] = np.asarray(points) @ np.diag((1, 2, 3))
    made.point_data["heat"] = points[:, 0]
    made.point_data["stress"] = np.einsum("ni,nj->nij", points, points).reshape(-1, 9)
    return made


def test_align_turns_active_and_named_arrays_alone(mesh):
    active = mesh.copy()
    active.set_active_vectors("wind")
    active.GetPointData().SetActiveTensors("stress")
    made = active.symmetry.align(mirror=PLANE)
    turn = symsurf.align(mesh, PLANE).matrix[:3, :3]
    wanted = mesh["wind"] @ turn.T
    stress = turn @ mesh["stress"].reshape(-1, 3, 3) @ turn.T
    np.testing.assert_allclose(made["wind"], wanted, atol=1e-12)
    np.testing.assert_allclose(made["stress"].reshape(-1, 3, 3), stress, atol=1e-12)
    np.testing.assert_array_equal(made["heat"], mesh["heat"])
    assert made.point_data.active_vectors_name == "wind"
    with warnings.catch_warnings():
        warnings.simplefilter("error", symsurf.InputWarning)
        named = mesh.symmetry.align(mirror=PLANE, kinds={"wind": "vector", "stress": "tensor"})
    np.testing.assert_allclose(named["wind"], wanted, atol=1e-12)
    mirrored = PLANE.reflect(active)
    np.testing.assert_allclose(
        mirrored["wind"], PLANE.reflect(mesh["wind"]) - PLANE.reflect(np.zeros((1, 3))), atol=1e-12
    )
    assert mirrored.point_data.active_vectors_name == "wind"


def test_arrays_of_unknown_kind_are_named(mesh):
    with pytest.warns(symsurf.InputWarning, match="wind is not turned") as told:
        made = mesh.symmetry.align(mirror=PLANE, kinds={"stress": "tensor"})
    assert len(told) == 1
    np.testing.assert_array_equal(made["wind"], mesh["wind"])
    with pytest.raises(symsurf.InvalidParameter, match="allowed are scalar, label"):
        symsurf.align(mesh, PLANE, kinds={"wind": "breeze"})
    with pytest.raises(symsurf.InvalidInput, match="heat of the kind vector have 1 components"):
        mesh.symmetry.align(mirror=PLANE, kinds={"heat": "vector", "wind": "scalar"})


def test_filters_turn_arrays_whose_kind_is_given(mesh):
    moving = filters.MirrorAlignment(
        input_data=mesh, method="plane", kinds="wind=vector,stress=tensor"
    )
    moving.Update()
    made, expected = (
        pyvista.wrap(moving.GetOutput()),
        mesh.symmetry.align(
            mirror=symsurf.detect(mesh, "plane").mirror,
            kinds={"wind": "vector", "stress": "tensor"},
        ),
    )
    for name in ("wind", "stress"):
        np.testing.assert_allclose(made[name], expected[name], atol=1e-9)
        assert not np.allclose(made[name], mesh[name])
    wrong = filters.MirrorAlignment(input_data=mesh, kinds="breeze=vector")
    assert "kinds has 'breeze=vector'; allowed is NAME=KIND" in error_of(wrong)


def test_filters_turn_active_vectors(mesh):
    active = mesh.copy()
    active.set_active_vectors("wind")
    moving = filters.MirrorAlignment(input_data=active, method="plane")
    moving.Update()
    made = pyvista.wrap(moving.GetOutput())
    turn = np.asarray(made.field_data["Matrix"]).reshape(4, 4)[:3, :3]
    np.testing.assert_allclose(made["wind"], mesh["wind"] @ turn.T, atol=1e-12)
    np.testing.assert_array_equal(made["stress"], mesh["stress"])
    mirror = detection_of(active)
    over = symsurf.vtk.MirrorReflection(input_data=active, mirror_data=mirror)
    over.Update()
    images, wind = pyvista.wrap(over.GetOutput()), mesh["wind"]
    plane = symsurf.detect(mesh, "plane").mirror
    np.testing.assert_allclose(
        images["wind"], wind - 2 * np.outer(wind @ plane.normal, plane.normal), atol=1e-9
    )
    np.testing.assert_array_equal(active["wind"], wind)


def detection_of(mesh):
    finding = symsurf.vtk.MirrorDetection(input_data=mesh, method="plane")
    finding.Update()
    return finding.GetOutputDataObject(1)


@pytest.mark.parametrize("mirror", MIRRORS.values(), ids=MIRRORS)
def test_images_of_half_a_shape_have_the_images_of_its_vectors(mirror):
    grid = pyvista.Plane(i_size=1, j_size=2, i_resolution=8, j_resolution=12)
    points = np.asarray(grid.points, dtype=float) * (0.9, 1, 1) + (0.5, 0, 0.2)
    half = symsurf.Shape(points @ TURN.T + 0.1 * TURN[:, 0], grid.triangulate().regular_faces)
    side = mirror.signed_distance(half.points) > 0.02
    cloud = half.points[side]
    wind = drawn("vector", len(cloud))
    whole = symsurf.complete(cloud, mirror, search=False)
    made = whole.carried(wind, "vector")
    own = AttributeTransform(mirror, cloud).jacobians
    own = own[whole.sources] if len(own) > 1 else own
    images = (own @ wind[whole.sources][:, :, None])[:, :, 0]
    wanted = np.where(whole.origin[:, None] > 0, images, wind[whole.sources])
    np.testing.assert_allclose(made, wanted, atol=1e-9)
    assert whole.origin.any()


def equivariant(points, plane):
    """Vectors, linear in the points, whose images over the plane are those at the images."""
    n = plane.normal
    arms = points - plane.reflect(np.zeros((1, 3))) / 2
    return 2 * arms + 3 * np.outer(arms @ n, n)


@pytest.mark.parametrize("name", ["symmetrize", "remesh", "transfer"])
def test_the_other_side_gets_images_of_vectors(mesh, name):
    shape = symsurf.Shape(np.asarray(mesh.points), mesh.regular_faces)
    shape = symsurf.Shape(shape.points + 0.1 * TURN[:, 0] - shape.points.mean(axis=0), shape.faces)
    plane = symsurf.detect(shape, "plane").mirror
    wind = equivariant(shape.points, plane)
    given = wind.copy()
    negative = plane.signed_distance(shape.points) < -1e-6
    given[negative] = 7  # what comes from the other side does not depend on them
    options = {"symmetrize": {"triangles": "mirrored", "side": "positive"}}
    if name == "transfer":
        made = symsurf.transfer({"wind": given}, shape, plane, kinds={"wind": "vector"})
        np.testing.assert_allclose(made.values["wind"], wind, atol=1e-6)
        return
    made = getattr(symsurf, name)(shape, plane, **options.get(name, {}))
    carried = made.carried(given, "vector")
    own = made.carried(given)
    images = made.partner < np.arange(len(made.partner))
    turned = plane.reflect(own[made.partner]) - plane.reflect(np.zeros((1, 3)))
    np.testing.assert_allclose(carried[images], turned[images], atol=1e-9)
    np.testing.assert_array_equal(carried[~images], own[~images])
    inside = ~np.isin(made.parents, np.flatnonzero(negative)).any(axis=1)
    exact = equivariant(made.shape.points, plane)
    np.testing.assert_allclose(carried[inside], exact[inside], atol=0.03)
    assert images.any() and inside.mean() > 0.8


def test_copies_about_an_axis_have_turned_vectors():
    rng = np.random.default_rng(3)
    axis = symsurf.Axis(np.array((0.3, 0.2, 0.1)), TURN[:, 2], 5)
    angle, radius, height = (
        rng.uniform(0, 1.2, 400),
        rng.uniform(0.5, 1, 400),
        rng.uniform(size=400),
    )
    local = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
    cloud = local @ TURN.T + axis.point
    made = symsurf.complete(cloud, axis)
    along = np.cross(axis.direction, cloud - axis.point) + 0.5 * axis.direction
    wanted = np.cross(axis.direction, made.shape.points - axis.point) + 0.5 * axis.direction
    np.testing.assert_allclose(made.carried(along, "vector"), wanted, atol=1e-9)
    assert made.origin.any()
    places = made.carried(cloud, "position")
    np.testing.assert_allclose(places, made.shape.points, atol=1e-9)


@pytest.mark.parametrize(
    "mirror", [MIRRORS["sphere"], MIRRORS["cylinder"]], ids=["sphere", "cylinder"]
)
def test_straightened_vectors_follow_the_map(mesh, mirror):
    points, along = np.asarray(mesh.points), drawn("vector", mesh.n_points)
    made = symsurf.straighten(points, mirror)
    step = 1e-4
    ends = [symsurf.bend(points + s * step * along, made.mirror) for s in (1, -1)]
    chord = (ends[0] - ends[1]) / (2 * step)
    # A sphere is laid out piece by piece: steps of different lengths differ where pieces meet.
    within = 1e-6 if mirror.kind == "cylinder" else 1e-3
    np.testing.assert_allclose(made.carried(along, "vector"), chord, atol=within)
