"""Half a model, and an exactly symmetric mesh of even triangles: closed, on the mirror, true."""

import numpy as np
import pytest
import pyvista
from command_line import run_here

import symsurf

PLANE = symsurf.Plane((1, 0.2, 0.1), 0.03)


def shape_of(mesh):
    mesh = mesh.triangulate()
    return symsurf.Shape(np.array(mesh.points, dtype=float), mesh.regular_faces)


def ball(nsub=4):
    return shape_of(pyvista.Icosphere(radius=1, nsub=nsub))


def box():
    return shape_of(pyvista.Cube(x_length=2, y_length=1.4, z_length=1).triangulate().subdivide(3))


def torus():
    mesh = pyvista.ParametricTorus(ringradius=1, crosssectionradius=0.35).clean().triangulate()
    return shape_of(mesh)


def of(made):
    return made.shape.to_pyvista()


def curved(kind):
    """A mirror through the middle of the ball."""
    if kind == "sphere":
        return symsurf.Sphere((3, 0, 0), 3)
    if kind == "cylinder":
        return symsurf.Cylinder((2.5, 0, 0), (0, 0, 1), 2.5)
    if kind == "quadric":
        matrix = np.diag([0, 0.2, 0.1])
        return symsurf.Quadric(matrix, (1, 0, 0), 0)
    return PLANE


@pytest.mark.parametrize("make", [ball, box, torus])
@pytest.mark.parametrize("side", ["positive", "negative"])
def test_a_closed_surface_is_cut_into_closed_halves(make, side):
    shape = make()
    made = symsurf.cut(shape, PLANE, side=side)
    whole, half = shape.to_pyvista(), of(made)
    other = of(symsurf.cut(shape, PLANE, side="negative" if side == "positive" else "positive"))
    assert half.is_manifold
    assert half.volume + other.volume == pytest.approx(whole.volume, rel=1e-9)
    sign = 1 if side == "positive" else -1
    assert (sign * PLANE.signed_distance(made.shape.points) >= -1e-12).all()
    corners = made.shape.points[made.shape.faces[made.cap]]
    np.testing.assert_allclose(PLANE.signed_distance(corners.reshape(-1, 3)), 0, atol=1e-12)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outwards = -sign * np.asarray(PLANE.normal)
    assert (normals @ outwards > -1e-12).all()
    np.testing.assert_array_equal(made.on_mirror[made.shape.faces[made.cap]], True)


@pytest.mark.parametrize("kind", ["plane", "sphere", "cylinder", "quadric"])
def test_half_a_model_and_its_exact_image_are_closed(kind):
    mirror = curved(kind)
    half = symsurf.cut(ball(), mirror, capped=False)
    whole = symsurf.complete(half.shape, mirror, search=False)
    assert of(whole).is_manifold
    own = whole.origin == 0
    np.testing.assert_array_equal(whole.shape.points[own], half.shape.points)
    np.testing.assert_array_equal(
        whole.shape.points[~own], mirror.reflect(half.shape.points)[whole.sources[~own]]
    )
    assert len(whole.patch.faces) == len(half.shape.faces)
    assert whole.statistics["points_on_mirror"] == half.on_mirror.sum()


def test_the_image_of_what_crosses_the_mirror_is_warned_of():
    with pytest.warns(symsurf.InputWarning, match="lie on the other side of the mirror"):
        whole = symsurf.complete(ball(), "x=0.5", search=False)
    assert len(whole.shape.faces) == 2 * len(ball().faces)


def test_a_plane_across_an_axis_is_a_mirror_everywhere(tmp_path):
    shape = ball()
    given = symsurf.complete(shape, "x=0").mirror
    assert (list(given.normal), given.offset, str(given.offset)) == ([1, 0, 0], 0, "0.0")
    assert symsurf.align(shape, " y = -1.5e-1").mirror.offset == 0.15
    np.testing.assert_array_equal(
        symsurf.bend(shape.points, "z=1"), symsurf.bend(shape.points, symsurf.Plane((0, 0, 1), -1))
    )
    assert symsurf.match(shape, "z=0").verdict == "found"
    symsurf.cut(shape, "x=0", capped=False).save(tmp_path / "half.ply")
    line = "complete half.ply --search false --mirror"
    done = run_here(f"{line} x=0 -o whole.ply", tmp_path)
    assert done.returncode == 0, done.stderr
    assert of_file(tmp_path / "whole.ply").is_manifold
    for wrong in ("x=", "w=0", "xy=1", "x=inf", "x=nan", "x=0=1", "=0"):
        with pytest.raises(symsurf.InvalidParameter, match="allowed is x, y or z and a finite"):
            symsurf.complete(shape, wrong)
        done = run_here(f"{line} {wrong}", tmp_path)
        assert done.returncode == 2 and f"--mirror is '{wrong}'" in done.stderr


def of_file(path):
    return symsurf.read(path).to_pyvista()


def test_curves_within_others_bound_holes():
    made = symsurf.cut(torus(), symsurf.Plane((0, 0, 1), 0))
    faces = made.shape.to_pyvista().extract_cells(np.flatnonzero(made.cap))
    ring = np.pi * (1.35**2 - 0.65**2)
    assert faces.area == pytest.approx(ring, rel=5e-3)
    assert made.statistics["open_curves"] == 0
    assert of(made).is_manifold
    two = symsurf.cut(torus(), symsurf.Plane((1, 0, 0), 0))
    discs = two.shape.to_pyvista().extract_cells(np.flatnonzero(two.cap))
    assert discs.area == pytest.approx(2 * np.pi * 0.35**2, rel=3e-2)
    assert of(two).is_manifold


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "quadric"])
def test_a_cap_lies_on_a_curved_mirror(kind):
    mirror = curved(kind)
    halves = [symsurf.cut(ball(), mirror, side=side) for side in ("positive", "negative")]
    for made in halves:
        assert of(made).is_manifold
        corners = np.unique(made.shape.faces[made.cap])
        np.testing.assert_allclose(mirror.signed_distance(made.shape.points[corners]), 0, atol=1e-9)
    whole = ball().to_pyvista().volume
    assert sum(of(made).volume for made in halves) == pytest.approx(whole, rel=1e-3)


def test_an_open_shape_keeps_its_rim_and_says_so():
    mesh = ball()
    open_ball = symsurf.Shape(
        mesh.points, mesh.faces[mesh.points[mesh.faces].mean(axis=1)[:, 2] < 0.5]
    )
    made = symsurf.cut(open_ball, symsurf.Plane((1, 0, 0), 0))
    assert made.statistics["open_curves"] == 1 and made.statistics["cap_faces"] == 0
    bare = symsurf.cut(mesh, PLANE, capped=False)
    assert not bare.cap.any() and "open_curves" not in bare.statistics
    rim = of(bare).extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    np.testing.assert_allclose(PLANE.signed_distance(rim.points), 0, atol=1e-6)
    cloud = symsurf.cut(mesh.points, PLANE)
    assert (PLANE.signed_distance(cloud.shape.points) >= -1e-12).all()
    assert len(cloud.shape.points) == (PLANE.signed_distance(mesh.points) >= -1e-12).sum()


@pytest.mark.parametrize("kind", ["plane", "sphere", "cylinder", "quadric"])
def test_remeshed_triangles_are_even_true_and_exactly_symmetric(kind):
    mirror, shape = curved(kind), ball()
    made = symsurf.remesh(shape, mirror, edge_length=0.02)
    points, faces = made.shape.points, made.shape.faces
    diagonal = np.linalg.norm(np.ptp(shape.points, axis=0))
    np.testing.assert_array_equal(made.partner[made.partner], np.arange(len(points)))
    np.testing.assert_allclose(mirror.reflect(points), points[made.partner], atol=1e-10)
    assert of(made).is_manifold
    edges = np.linalg.norm(points[faces] - points[np.roll(faces, 1, axis=1)], axis=2)
    target = 0.02 * diagonal
    even = (edges > 0.5 * target) & (edges < 1.5 * target)
    assert even.mean() > 0.98
    kept = mirror.signed_distance(points) >= 0

    assert np.abs(points_distance(points[kept], shape)).max() < 1e-3 * diagonal


def points_distance(points, shape):
    made = pyvista.PolyData(points).compute_implicit_distance(shape.to_pyvista())
    return made["implicit_distance"]


def test_sharp_edges_and_corners_stay():
    made = symsurf.remesh(box(), symsurf.Plane((1, 0, 0), 0), edge_length=0.05)
    mesh = of(made)
    assert mesh.is_manifold
    assert mesh.volume == pytest.approx(2 * 1.4 * 1, rel=1e-7)  # of single precision
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-0.7, 0.7) for z in (-0.5, 0.5)])
    nearest = np.linalg.norm(made.shape.points[:, None] - corners, axis=2).min(axis=0)
    np.testing.assert_allclose(nearest, 0, atol=1e-7)


def test_soups_are_welded_first():
    shape = ball(3)
    soup = symsurf.Shape(
        shape.points[shape.faces.ravel()], np.arange(shape.faces.size).reshape(-1, 3)
    )
    assert of(symsurf.remesh(soup, PLANE)).is_manifold


def test_attributes_go_along(tmp_path):
    shape = ball(3)
    mesh = shape.to_pyvista()
    mesh.point_data["height"] = shape.points[:, 2]
    mesh.cell_data["patch"] = np.arange(mesh.n_cells)
    mesh.symmetry.result = symsurf.match(mesh, symsurf.Plane((1, 0, 0), 0))
    for name in ("remesh", "cut"):
        made = getattr(mesh.symmetry, name)()
        assert set(made.cell_data["patch"]) <= set(range(mesh.n_cells))
        own = made.point_data["height"]
        assert own.min() < -0.8 and own.max() > 0.8
    assert made.cell_data["cap"].sum() > 0
    shape.to_pyvista().save(tmp_path / "ball.ply")
    done = run_here("cut ball.ply --output out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert b"property uchar cap" in (tmp_path / "out/ball.ply").read_bytes()
    assert symsurf.read(tmp_path / "out/ball.ply").to_pyvista().is_manifold
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in shape.points.tolist()]
    lines += ["f " + " ".join(str(c + 1) for c in face) for face in shape.faces]
    (tmp_path / "ball.obj").write_text("\n".join(lines) + "\n")
    assert run_here("cut ball.obj --output out", tmp_path).returncode == 0
    text = (tmp_path / "out/ball.obj").read_text()
    group = text[text.index("\ng cap\n") :].count("\nf ")
    assert group == symsurf.cut(shape, symsurf.detect(shape)).cap.sum()


@pytest.mark.parametrize("name", ["cut", "remesh"])
def test_a_mirror_beside_the_shape_is_an_error(name):
    with pytest.raises(symsurf.InvalidInput, match="none of the .* lies on the positive side"):
        getattr(symsurf, name)(ball(2), symsurf.Plane((1, 0, 0), -2))


def test_a_cloud_cannot_be_remeshed():
    with pytest.raises(symsurf.InvalidInput, match="remesh needs a mesh"):
        symsurf.remesh(ball(2).points, PLANE)


def with_a_fin(shape):
    return symsurf.Shape(
        np.vstack([shape.points, [(2, 2, 2)]]),
        np.vstack([shape.faces, [(*shape.faces[0][:2], len(shape.points))]]),
    )


def with_faces_turned(shape):
    faces = shape.faces.copy()
    faces[::3] = faces[::3, ::-1]
    return symsurf.Shape(shape.points, faces)


def with_faces_twice(shape):
    degenerate = shape.faces[::5].copy()
    degenerate[:, 1] = degenerate[:, 0]
    return symsurf.Shape(shape.points, np.vstack([shape.faces, shape.faces[:50, ::-1], degenerate]))


@pytest.mark.parametrize("spoil", [with_a_fin, with_faces_turned, with_faces_twice])
def test_unclean_meshes_are_repaired(spoil):
    shape = ball(3)
    made = symsurf.remesh(spoil(shape), PLANE, edge_length=0.03)
    whole = shape.to_pyvista()
    if spoil is not with_a_fin:
        assert of(made).is_manifold
        assert abs(of(made).volume) == pytest.approx(whole.volume, rel=0.1)
    assert made.statistics["surface_distance_of_diagonal"] < 0.005
    half = symsurf.cut(spoil(shape), PLANE)
    assert (np.diff(np.sort(half.shape.faces, axis=1), axis=1) > 0).all()


def long_torus():
    """Sixteen steps along, 48 across."""
    u, w = np.meshgrid(np.arange(16) / 16, np.arange(48) / 48, indexing="ij")
    u, w = 2 * np.pi * u.ravel(), 2 * np.pi * w.ravel()
    r = 1 + 0.1 * np.cos(w)
    i = np.arange(16 * 48).reshape(16, 48)
    a, b, c, d = i, np.roll(i, -1, 0), np.roll(np.roll(i, -1, 0), -1, 1), np.roll(i, -1, 1)
    faces = np.vstack(
        [np.c_[a.ravel(), b.ravel(), c.ravel()], np.c_[a.ravel(), c.ravel(), d.ravel()]]
    )
    return symsurf.Shape(np.c_[r * np.cos(u), r * np.sin(u), 0.1 * np.sin(w)], faces)


def slender_cylinder():
    return shape_of(pyvista.Cylinder(radius=0.1, height=1, resolution=32).clean())


@pytest.mark.parametrize("make", [long_torus, slender_cylinder])
@pytest.mark.parametrize("plane", [symsurf.Plane((1, 0, 0), 0), symsurf.Plane((0, 1, 0), 0)])
def test_long_triangles_keep_their_surface(make, plane):
    shape = make()
    made = symsurf.remesh(shape, plane)
    assert of(made).is_manifold
    assert of(made).volume == pytest.approx(shape.to_pyvista().volume, rel=0.05)
    assert made.statistics["surface_distance_of_diagonal"] < 0.005


def test_triangles_far_from_the_surface_are_warned_of():
    with pytest.warns(symsurf.InputWarning, match="% of the diagonal, from the surface"):
        made = symsurf.remesh(ball(), PLANE, edge_length=0.3)
    own = PLANE.signed_distance(ball().points) >= 0
    distance = np.abs(points_distance(ball().points[own], made.shape)).max()
    assert made.statistics["surface_distance"] >= distance * (1 - 1e-5)
    assert made.statistics["surface_distance_of_diagonal"] > 0.005


@pytest.mark.parametrize("name", ["cut", "remesh"])
def test_the_order_of_the_faces_does_not_matter(name, rng):
    shape = torus()
    given = [shape, symsurf.Shape(shape.points, rng.permutation(shape.faces))]
    one, other = (getattr(symsurf, name)(each, PLANE) for each in given)
    np.testing.assert_array_equal(one.shape.points, other.shape.points)
    ordered = [np.unique(np.sort(made.shape.faces, axis=1), axis=0) for made in (one, other)]
    np.testing.assert_array_equal(*ordered)


def test_an_even_cap_has_triangles_like_the_others():
    plain, even = (symsurf.cut(ball(), PLANE, even_cap=each) for each in (False, True))
    areas = [of(made).compute_cell_sizes()["Area"][made.cap] for made in (plain, even)]
    assert areas[0].sum() == pytest.approx(areas[1].sum(), rel=1e-9)
    assert of(plain).is_manifold and of(even).is_manifold
    others = of(even).compute_cell_sizes()["Area"][~even.cap].mean()
    assert others / 3 < areas[1].mean() < 3 * others


def test_a_surface_with_split_vertices_is_closed_too():
    """A cylinder whose ends have vertices of their own, as flat shading makes them."""
    mesh = pyvista.Cylinder(resolution=40).triangulate()
    assert mesh.n_open_edges > 0
    whole = mesh.clean()
    for plane in (PLANE, symsurf.Plane((0, 1, 0), 0)):
        halves = [symsurf.cut(mesh, plane, side=side) for side in ("positive", "negative")]
        assert all(made.statistics["open_curves"] == 0 for made in halves)
        volumes = [of(made).clean().volume for made in halves]
        assert all(of(made).clean().is_manifold for made in halves)
        assert sum(volumes) == pytest.approx(whole.volume, rel=1e-6)


def test_points_whose_feet_are_out_of_reach_stay():
    """Over a quadric whose numbers are out of all proportion, as fuzzing drew one."""
    points = [(2, 0, 0), (2, 0, 1), (0, 2, 2), (2, 0, 0), (2, 0, 1), (1, 2, 1), (1, 2, 0)]
    points += [(2, 0, 2), (0, 1, 1), (1, 2, 2), (2, 1, 0), (2, 1, 2), (1, 0, 0), (2, 0, 0)]
    points += [(1, 2, 2), (1, 2, 1), (1, 1, 0), (2, 0, 0), (2, 2, 0), (2, 1, 0)]
    faces = [(6, 4, 13), (6, 5, 12), (14, 18, 8), (10, 10, 7), (17, 6, 3), (11, 5, 5)]
    matrix = np.array([[0.3, -1.8, 0.3], [-1.5, -0.5, -1.3], [0.1, 1.2, 1e50]])
    mirror = symsurf.Quadric(matrix, (0.6, -1.9, 1.3), 1.5)
    made = symsurf.remesh(symsurf.Shape(np.array(points, float), faces), mirror)
    assert np.isfinite(made.shape.points).all()
    assert made.parents.min() >= 0 and made.parents.max() < len(points)


@pytest.mark.parametrize("capped", [True, False])
def test_half_a_cloud_as_an_object_of_pyvista(capped):
    side = np.abs(np.random.default_rng(0).normal(size=(500, 3))) + 0.1
    cloud = pyvista.PolyData(np.vstack([side, side * (-1, 1, 1)]))
    cloud["number"] = np.arange(1000)
    half = symsurf.cut(cloud, symsurf.Plane((1, 0, 0), 0), capped=capped).like(cloud)
    assert (half.points[:, 0] > 0).all() and set(half["number"]) == set(range(500))
    assert "on_mirror" in half.point_data and "cap" not in half.cell_data
    lattice = pyvista.ImageData(dimensions=(4, 4, 4)).cast_to_unstructured_grid()
    grid = pyvista.PolyData(np.asarray(lattice.points)).cast_to_unstructured_grid()
    assert symsurf.cut(grid, symsurf.Plane((1, 0, 0), -1.5)).like(grid).n_points == 32


def test_values_of_another_mesh_are_an_error():
    mesh = ball(2)
    half = symsurf.cut(mesh, PLANE)
    transferred = symsurf.transfer(None, mesh, PLANE)
    for carry in (half.carried, transferred.carried, transferred.displaced):
        for count in (len(mesh.points) - 1, len(mesh.points) + 1):
            says = f"has shape \\({count}, 3\\); allowed is one value per point: \\({len(mesh.points)}, "
            with pytest.raises(symsurf.InvalidInput, match=says):
                carry(np.zeros((count, 3)))


def test_a_rim_without_an_image_has_no_counterpart():
    """The centre of a disc within a sphere, at the rim as a sector is missing."""
    angle = 2 * np.pi * np.arange(12) / 12
    ring = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    points = np.vstack([np.zeros(3), 0.5 * ring, ring])
    inner, after = 1 + np.arange(12), 1 + (np.arange(12) + 1) % 12
    faces = np.vstack(
        [
            np.column_stack([0 * inner, inner, after])[:-1],
            np.column_stack([inner, inner + 12, after + 12]),
            np.column_stack([inner, after + 12, after]),
        ]
    )
    half = symsurf.Shape(points, faces)
    found = symsurf.asymmetry(half, symsurf.Sphere((0, 0, 0), 1))
    assert not found.matched[0]
    assert np.isfinite(found.confidence).all()
