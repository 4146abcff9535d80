"""Two shapes of a pair: laid onto each other, in Python and on the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import random_rotation

import symsurf
from symsurf import Shape


def body(seed: int = 0, count: int = 2000) -> np.ndarray:
    """Random points of a body without a mirror."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    x, y, z = points.T
    return points * np.exp(0.2 * (np.sin(3 * x + 1) + np.cos(4 * y - z) + np.sin(2 * z + 2 * x * y)))[:, None]  # fmt: skip


def image(points: np.ndarray, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """The points reflected and placed, and the map."""
    rng = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3, :3] = random_rotation(rng) @ np.diag([-1, 1, 1])
    matrix[:3, 3] = rng.normal(size=3)
    return points @ matrix[:3, :3].T + matrix[:3, 3], matrix


def test_a_shape_is_laid_on_its_image():
    left = body()
    right, matrix = image(left)
    found = symsurf.match_pair(left, right)
    assert found.verdict == "found" and found.score == pytest.approx(1)
    np.testing.assert_allclose(found.matrix, matrix, atol=1e-9)
    np.testing.assert_array_equal(found.index, np.arange(len(left)))
    assert np.linalg.det(found.matrix[:3, :3]) == pytest.approx(-1)
    assert repr(found) == "PairMatch(Shape(2000 points, no faces, no normals), found, score 1.000)"


def test_what_is_no_pair_is_told(tmp_path):
    found = symsurf.match_pair(body(), np.random.default_rng(0).uniform(-1, 1, (2000, 3)))
    assert found.verdict == "none" and "minimum_score" in found.reason
    found.save(tmp_path / "none.json")
    assert json.loads((tmp_path / "none.json").read_text())["statistics"]["verdict"] == "none"


def test_shapes_of_different_size_are_refused():
    with pytest.raises(symsurf.InvalidInput, match="both must be in one unit"):
        symsurf.match_pair(body(), 10 * body())
    with pytest.raises(TypeError):
        symsurf.match_pair(body())
    with pytest.raises(symsurf.InvalidInput, match="symmetries takes no second shape"):
        symsurf.shape_analyses.analyse.analyse("symmetries", body(), body())


def test_files_and_folders_of_them(tmp_path):
    right, matrix = image(body())
    (tmp_path / "left").mkdir()
    (tmp_path / "right").mkdir()
    np.savetxt(tmp_path / "left" / "a.xyz", body(), fmt="%.17g")
    np.savetxt(tmp_path / "right" / "a.xyz", right, fmt="%.17g")
    for other in ("right/a.xyz", "right"):
        ran = run_here(f"match_pair left/a.xyz --other {other} --json", tmp_path)
        found = json.loads(ran.stdout)["transformations"][0]
        np.testing.assert_allclose(found["matrix"], matrix, atol=1e-9)
    ran = run_here("match_pair left/a.xyz --other right/b.xyz", tmp_path)
    assert ran.returncode == 1 and "b.xyz" in ran.stderr


def test_meshes():
    pyvista = pytest.importorskip("pyvista")
    hills = pyvista.examples.load_random_hills()
    right = hills.reflect((0, 1, 0)).rotate_x(50)
    found = symsurf.match_pair(hills, right)
    np.testing.assert_allclose(hills.transform(found.matrix, inplace=False).points, right.points, atol=1e-4)  # fmt: skip
    assert isinstance(found.shape, Shape) and found.arrays["distance"].max() < 1e-4


def bumpy_mesh(subdivisions: int = 4) -> Shape:
    """A closed mesh of such a body."""
    pyvista = pytest.importorskip("pyvista")
    ball = pyvista.Icosphere(nsub=subdivisions)
    x, y, z = np.asarray(ball.points, float).T
    waves = np.sin(3 * x + 1) + np.cos(4 * y - z) + np.sin(2 * z + 2 * x * y)
    return Shape(np.exp(0.2 * waves)[:, None] * np.column_stack([x, y, z]), ball.regular_faces)


def without_top(shape: Shape, height: float) -> Shape:
    kept = shape.points[:, 2] < height
    faces = shape.faces[kept[shape.faces].all(axis=1)]
    number = np.cumsum(kept) - 1
    return Shape(shape.points[kept], number[faces])


def mirrored(shape: Shape) -> Shape:
    return Shape(image(shape.points)[0], shape.faces[:, ::-1])


def test_asymmetry_is_that_of_a_bump():
    left = bumpy_mesh()
    x = left.points / np.linalg.norm(left.points, axis=1, keepdims=True)
    height = 0.05 * np.clip(1 - np.linalg.norm(x - (0, 0, 1), axis=1) / 0.4, 0, 1)
    bumped = Shape(left.points * (1 + height[:, None]), left.faces)
    found = symsurf.asymmetry(bumped, other=mirrored(left))
    assert found.matched.all() and len(found.distance) == len(left.points)
    top = x[:, 2].argmax()
    assert found.signed[top] == pytest.approx(
        -height[top] * np.linalg.norm(left.points[top]), rel=0.3
    )
    assert np.median(found.distance) < 1e-3
    figures = found.statistics
    assert figures["pair_verdict"] == "found" and figures["volume_index"] > 0
    assert figures["diagonal"] == pytest.approx(np.linalg.norm(np.ptp(bumped.points, axis=0)))


def test_correspondences_are_rows_of_the_other():
    left = bumpy_mesh(3)
    order = np.random.default_rng(0).permutation(len(left.points))
    right = mirrored(left)
    shuffled = Shape(right.points[order], np.argsort(order)[right.faces])
    found = symsurf.correspondences(left, other=shuffled)
    np.testing.assert_array_equal(order[found.index], np.arange(len(left.points)))
    assert found.statistics["paired_share"] == 1
    places = np.einsum("nk,nkd->nd", found.weights, shuffled.points[shuffled.faces[found.face]])
    np.testing.assert_allclose(places, right.points, atol=1e-9)
    clouds = symsurf.correspondences(left.points, other=shuffled.points)
    np.testing.assert_array_equal(order[clouds.index], np.arange(len(left.points)))


@pytest.mark.parametrize("wound", ["outwards", "inwards"])
def test_the_other_completes_what_is_broken(wound):
    pyvista = pytest.importorskip("pyvista")
    left = bumpy_mesh(5)
    broken = without_top(left, 0.6)
    right = mirrored(left)
    if wound == "inwards":
        right = Shape(right.points, right.faces[:, ::-1])
    found = symsurf.complete(broken, other=right)
    np.testing.assert_array_equal(found.shape.points[: len(broken.points)], broken.points)
    closed = pyvista.PolyData.from_regular_faces(found.shape.points, found.shape.faces)
    whole = pyvista.PolyData.from_regular_faces(left.points, left.faces)
    assert closed.n_open_edges == 0
    assert closed.volume == pytest.approx(whole.volume, rel=1e-3)
    assert set(np.unique(found.origin)) <= {0, 1, 2}
    assert found.sources.max() < len(broken.points)


def test_what_the_other_is_refused_with():
    left, right = bumpy_mesh(3), mirrored(bumpy_mesh(3))
    with pytest.raises(symsurf.InvalidParameter, match="mirror and other are both given"):
        symsurf.asymmetry(left, symsurf.Plane((1, 0, 0), 0), other=right)
    with pytest.raises(symsurf.InvalidInput, match="one of the two shapes has faces"):
        symsurf.asymmetry(left, other=right.points)
    with pytest.raises(symsurf.InvalidParameter, match="search is false beside a second shape"):
        symsurf.complete(left, other=right, search=False)
    with pytest.raises(symsurf.InvalidInput, match="align takes no second shape"):
        symsurf.align(left, other=right)
    box = np.random.default_rng(0).uniform(-1, 1, (2000, 3))
    with pytest.warns(symsurf.InputWarning, match="the two shapes are no pair"):
        symsurf.correspondences(left.points, other=box)
    with pytest.raises(symsurf.InvalidInput, match="the two shapes are no pair"):
        symsurf.correspondences(left.points, other=box, require_found=True)


def test_the_command_line_takes_the_other(tmp_path):
    np.savetxt(tmp_path / "left.xyz", body(), fmt="%.17g")
    np.savetxt(tmp_path / "right.xyz", image(body())[0], fmt="%.17g")
    ran = run_here("asymmetry left.xyz --other right.xyz --json", tmp_path)
    assert json.loads(ran.stdout)["statistics"]["maximum"] < 1e-6


def test_vtk_takes_the_other():
    pytest.importorskip("vtkmodules")
    pyvista = pytest.importorskip("pyvista")
    from symsurf.vtk import MirrorAsymmetry, SymmetryAnalysis

    left, right = (
        pyvista.PolyData.from_regular_faces(each.points, each.faces)
        for each in (bumpy_mesh(3), mirrored(bumpy_mesh(3)))
    )
    for filter_, array in (
        (SymmetryAnalysis(analysis="match_pair"), "PairMatchingDistance"),
        (MirrorAsymmetry(), "MirrorAsymmetryDistance"),
    ):
        filter_.input_data, filter_.other_data = left, right
        filter_.Update()
        assert pyvista.wrap(filter_.output)[array].max() < 1e-6
