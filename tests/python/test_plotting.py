"""Pictures, looked at by their pixels."""

from __future__ import annotations

import dataclasses
import sys
from itertools import pairwise

import numpy as np
import pytest
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf import synthetic
from symsurf.mirror_operations.operate import operate
from symsurf.plotting import operation_plotting, result_plotting
from symsurf.plotting.drawing import new_plotter

BACKGROUND, UNPAIRED = (255, 255, 255), (0x9A, 0xA3, 0xAD)


@pytest.fixture(scope="module")
def result():
    points, truth = mirrored_surface(800, 0)
    return symsurf.match(points, truth)


def pixels(path):
    pyvista = pytest.importorskip("pyvista")
    return np.asarray(pyvista.read(path).point_data.active_scalars)[:, :3].astype(int)


def bluish(picture):
    """The share of the mirror, as it is drawn."""
    return (picture[:, 2] > picture[:, 0] + 20).mean()


def test_picture_shows_object_and_mirror(result, tmp_path):
    result.plot(tmp_path / "both.png")
    both = pixels(tmp_path / "both.png")
    drawn = (both != BACKGROUND).any(axis=1)
    assert 0.1 < drawn.mean() < 0.9
    assert bluish(both) > 0.02


def test_picture_of_a_mesh(tmp_path):
    points = np.array([(x, y, 0.2 * y) for x in (-2.0, -1, 1, 2) for y in (0.0, 1, 3)])
    faces = [
        (3 * i + j, 3 * i + j + 1, 3 * i + j + 3 + k)
        for i in range(3)
        for j in range(2)
        for k in (0, 1)
    ]
    shape = symsurf.Shape(points, np.array(faces))
    result = symsurf.match(points, symsurf.Plane((1, 0, 0), 0))
    result.plot(tmp_path / "mesh.png", shape=shape)
    result.plot(tmp_path / "points.png", points=points)
    difference = pixels(tmp_path / "mesh.png") != pixels(tmp_path / "points.png")
    assert difference.any(axis=1).mean() > 0.02


def test_picture_without_the_mirror_where_it_maps_no_point(result, tmp_path):
    """A sphere has no mesh there, a free form an empty one; both leave the bare object."""
    points = result.points
    free_form = symsurf.detect(points, "perpendicular").mirror
    over = free_form.mesh()[0]
    beside = 500 * np.linalg.svd(over - over.mean(axis=0), full_matrices=False)[2][0]
    for mirror, moved in (symsurf.Sphere((500, 0, 0), 1), 0), (free_form, beside):
        symsurf.match(points + moved, mirror).plot(tmp_path / "bare.png")
        bare = pixels(tmp_path / "bare.png")
        grey = (abs(bare - UNPAIRED) < 10).all(axis=1).mean()
        assert grey > 0.002 and bluish(bare) == 0


@pytest.mark.parametrize("surface", ["f1", "f2", "f4", "f6"])
def test_nothing_is_cut_off(surface, tmp_path):
    sample = synthetic.mirror_perpendicular(surface, 2, 30, 0.3)
    symsurf.match(sample.points, sample.truth).plot(tmp_path / "sheets.png")
    picture = pixels(tmp_path / "sheets.png").reshape(900, 1200, 3)
    drawn = (picture != BACKGROUND).any(axis=2)
    edges = drawn[0], drawn[-1], drawn[:, 0], drawn[:, -1]
    assert not any(edge.any() for edge in edges)
    # Nor is there much room left, where the picture is wide or high enough.
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    assert np.ptp(rows) > 0.85 * 900 and np.ptp(columns) > 0.3 * 1200


def test_points_that_are_not_finite_are_not_drawn(result, tmp_path):
    result.plot(tmp_path / "finite.png")
    points = np.vstack([result.points, np.full((40, 3), np.nan)])
    with pytest.warns(symsurf.InputWarning):
        symsurf.match(points, result.mirror).plot(tmp_path / "some.png")
    difference = pixels(tmp_path / "finite.png") - pixels(tmp_path / "some.png")
    assert (abs(difference) > 32).any(axis=1).mean() < 0.01
    with pytest.raises(symsurf.InvalidInput, match="none of the 800 points is finite"):
        result.plot("never.png", points=np.full((800, 3), np.inf))


def test_the_faces_of_a_mesh_are_drawn(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Cube(x_length=1, y_length=2, z_length=3).triangulate().clean()
    result = symsurf.detect(mesh, "plane")
    result.plot(tmp_path / "mesh.png")
    result.plot(tmp_path / "points.png", points=mesh.points)
    drawn = [
        (pixels(tmp_path / name) != BACKGROUND).any(axis=1).mean()
        for name in ("mesh.png", "points.png")
    ]
    assert drawn[0] > 0.2 and drawn[0] > 1.2 * drawn[1]


def test_the_verdict_is_written_above(result, tmp_path):
    """Ink where nothing is drawn without a verdict; more of it for a longer text."""
    ink = []
    found = symsurf.detect(result.points, "plane")
    unjudged = dataclasses.replace(found, statistics={})
    judged = dataclasses.replace(found, statistics=found.statistics | {"verdict": "found" * 4})
    for shown in (unjudged, found, judged):
        shown.plot(tmp_path / "title.png")
        top = pixels(tmp_path / "title.png").reshape(900, 1200, 3)[-40:]
        ink.append((top < 120).all(axis=2).sum())
    assert ink[0] == 0 and 300 < ink[1] < ink[2]


def test_outliers_are_out_of_the_picture(tmp_path):
    """What is drawn fills about as much of the picture without them, and the mirror is no larger."""
    pyvista = pytest.importorskip("pyvista")
    points, _ = mirrored_surface(800, 0)
    outliers = 300 * np.random.default_rng(0).normal(size=(5, 3))
    shares, sizes = [], []
    for given in points, np.vstack([points, outliers]):
        result = symsurf.detect(given, "plane")
        result.plot(tmp_path / "given.png")
        picture = pixels(tmp_path / "given.png")
        shares.append([(picture != BACKGROUND).any(axis=1).mean(), bluish(picture)])
        result.save(tmp_path / "given.vtp")
        sizes.append(pyvista.read(tmp_path / "given.vtp").length)
    assert result.statistics["outliers"] == 5
    np.testing.assert_allclose(shares[1], shares[0], rtol=0.6)
    assert sizes[1] < 1.2 * sizes[0]


def test_points_that_do_not_belong(result):
    pytest.importorskip("pyvista")
    with pytest.raises(symsurf.InvalidInput, match="10 points"):
        result.plot("never.png", points=result.points[:10])


def test_without_pyvista(result, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"symsurf\[plot\]"):
        result.plot("never.png")


def share_of(picture, colour, near=40):
    """How much of the picture has about that hue: light changes the brightness."""
    unit = np.array(colour) / np.linalg.norm(colour)
    lengths = np.linalg.norm(picture, axis=1)
    alike = (picture @ unit) > np.cos(np.radians(8)) * lengths
    return (alike & (lengths > near) & (np.ptp(picture, axis=1) > 25)).mean()


def test_the_end_of_the_colours(result, tmp_path):
    """Residuals of one percent are dark where the colours end there, light where they go further."""
    noisy = result.points + 0.02 * np.random.default_rng(0).normal(size=result.points.shape)
    shown = symsurf.match(noisy, result.mirror)
    darkness = []
    for clim in (0.5, 50):
        shown.plot(tmp_path / "noisy.png", clim=clim)
        picture = pixels(tmp_path / "noisy.png")
        picture = picture[(picture != BACKGROUND).any(axis=1)]
        darkness.append((picture[:, 1] < 100).mean())
    assert darkness[0] > darkness[1] + 0.05


def test_the_camera_and_no_score(result, tmp_path):
    views = {"default": None, "direction": (1, 0, 0), "other": (0, 1, 0), "name": "xy"}
    pictures = {}
    for name, camera in views.items():
        result.plot(tmp_path / "view.png", camera=camera, score=False)
        pictures[name] = pixels(tmp_path / "view.png")
        top = pictures[name].reshape(900, 1200, 3)[-40:]
        assert not (top < 120).all(axis=2).any()  # no ink
        assert (pictures[name] != BACKGROUND).any(axis=1).mean() > 0.05
    for one, other in pairwise(pictures):
        assert (pictures[one] != pictures[other]).any(axis=1).mean() > 0.02


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"clim": 0}, "clim is 0; allowed is a number"),
        ({"clim": "1"}, "clim is '1'"),
        ({"camera": (0, 0, 0)}, "camera is .0, 0, 0"),
        ({"camera": "from above"}, "camera is 'from above'"),
    ],
)
def test_what_cannot_be_drawn_is_named(result, options, says, tmp_path):
    pytest.importorskip("pyvista")
    with pytest.raises(symsurf.InvalidParameter, match=says):
        result.plot(tmp_path / "never.png", **options)
    with pytest.raises(symsurf.InvalidParameter, match=says):
        symsurf.align(result.points, result).plot(tmp_path / "never.png", **options)
    assert not (tmp_path / "never.png").exists()


@pytest.mark.parametrize("name", symsurf.operations())
@pytest.mark.parametrize("is_mesh", [True, False], ids=["mesh", "cloud"])
def test_pictures_of_operations(name, is_mesh, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Icosphere(radius=1, nsub=4)
    points = np.array(mesh.points, dtype=float) * (0.8, 1, 1.3)
    shape = symsurf.Shape(points, mesh.regular_faces if is_mesh else None)
    if symsurf.operations()[name].needs_faces and not is_mesh:
        pytest.skip("takes meshes alone")
    made = operate(name, shape, symsurf.Plane((1, 0, 0), 0))
    made.plot(tmp_path / "picture.png", camera=(1, -1, 0.5))
    picture = pixels(tmp_path / "picture.png")
    assert 0.1 < (picture != BACKGROUND).any(axis=1).mean() < 0.9
    if name != "cut" or not is_mesh:  # the cap lies within the mirror
        assert bluish(picture) > 0.01
    edges = picture.reshape(900, 1200, 3)
    assert (edges[:, [0, -1]] == BACKGROUND).all()


def test_asymmetry_is_red_and_blue_alike(tmp_path):
    """A dent is red where it is, and blue on the other side; seen along the mirror, as large."""
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Icosphere(radius=1, nsub=5)
    points = np.array(mesh.points, dtype=float)
    away = np.linalg.norm(points - (0.6, -0.8, 0), axis=1) / 0.4
    dented = points * (1 - 0.05 * np.exp(-(away**2)))[:, None]
    for shape in (dented, dented * (-1, 1, 1)):
        asymmetry = symsurf.asymmetry(shape, symsurf.Plane((1, 0, 0), 0), faces=mesh.regular_faces)
        asymmetry.plot(tmp_path / "dent.png", camera=(0, -1, 0))
        picture = pixels(tmp_path / "dent.png").reshape(900, 1200, 3)[100:780]
        sides = [half.reshape(-1, 3) for half in np.split(picture, 2, axis=1)]
        red = [share_of(half, (0xA8, 0x32, 0x44)) for half in sides]
        blue = [share_of(half, (0x2F, 0x5F, 0xB0)) for half in sides]
        dent = int(shape is dented)  # on the right, as x points there
        assert red[dent] > 0.01 and red[1 - dent] < 0.1 * red[dent]
        assert blue[1 - dent] > 0.01
        assert asymmetry.signed[np.abs(asymmetry.signed).argmax()] != 0


def test_homologous_asymmetry_is_grey_along_the_surface_where_it_may_be_none(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Icosphere(nsub=3)
    points = np.array(mesh.points, dtype=float) * (1, 0.8, 1.2)
    twisted = points + 0.1 * np.clip(points[:, :1], 0, None) * np.cross(points, (1, 0, 0))
    found = symsurf.asymmetry(
        symsurf.Shape(twisted, mesh.regular_faces),
        symsurf.Plane((1, 0, 0), 0),
        pairing="homologous",
    )
    greys = []
    for deviations in (0.0, found.tangential.max()):
        made = dataclasses.replace(found, vector_sd=np.full(len(points), deviations))
        made.plot(tmp_path / "both.png", score=False)
        picture = pixels(tmp_path / "both.png").reshape(900, 1200, 3)[:, 600:].reshape(-1, 3)
        greys.append((np.ptp(picture, axis=1) < 25) & (picture.max(axis=1) < 250))
    assert greys[0].mean() < 0.05
    assert greys[1].mean() > 0.2


def test_straightening_shows_before_and_after(tmp_path):
    pytest.importorskip("pyvista")
    points, _ = mirrored_surface(900, 0)
    bent = symsurf.bend(points, symsurf.Cylinder((-3, 0, 0), (0, 1, 0), 3), back=True)
    mirror = symsurf.detect_cylinder(bent).mirror
    symsurf.straighten(bent, mirror).plot(tmp_path / "both.png")
    picture = pixels(tmp_path / "both.png").reshape(900, 1200, 3)
    for half in np.split(picture, 2, axis=1):
        assert 0.02 < (half.reshape(-1, 3) != BACKGROUND).any(axis=1).mean() < 0.9


def test_detections_are_coloured_by_the_asymmetry_of_the_surface():
    """Which does not depend on where the vertices lie on it."""
    pyvista = pytest.importorskip("pyvista")
    rng = np.random.default_rng(0)
    mesh = pyvista.Icosphere(nsub=3)
    points = mesh.points + rng.normal(scale=0.01, size=mesh.points.shape)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    shape = symsurf.Shape(points * (1, 1.3, 0.8), mesh.regular_faces)
    result = symsurf.match(shape, symsurf.Plane((1, 0, 0), 0))
    plotter = new_plotter(off_screen=True)
    result_plotting.draw(plotter, result)
    title = "asymmetry, % of the diagonal"
    assert list(plotter.scalar_bars.keys()) == [title]
    drawn = next(each for each in plotter.meshes if title in each.array_names)
    assert drawn[title].max() < 50 * np.median(result.residuals) / drawn.length


def test_parts_have_legends_that_can_be_read():
    grid = np.linspace(-1, 1, 21)
    points = np.array([(x, y, 0.2 * y * y) for x in grid for y in grid if x < 0.5])
    result = symsurf.complete(points, symsurf.Plane((1, 0, 0), 0))
    assert set(result.origin) == {0, 1}
    plotter = new_plotter(off_screen=True)
    operation_plotting.draw(plotter, result)
    assert list(plotter.scalar_bars.keys()) == ["original", "mirrored"]
