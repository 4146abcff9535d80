"""Gaussian splats as a renderer shows them, and ``.splat`` files."""

import numpy as np
import pytest
from symmetric_shapes import random_rotation
from test_directed_files import PLANE, TURN, covariances, read, splats, write
from test_directed_files import SPLAT as NAMES
from test_kinds import lobe_basis

import symsurf
from symsurf.reading.splat import SPLAT

CAMERA = random_rotation(np.random.default_rng(4))
"""Columns: to the right, up, and the way of the view."""
PIXELS = 40


def rendered(centres, spreads, colours, opacities, camera):
    """(PIXELS, PIXELS, 3) parallel projection of Gaussians (Zwicker et al. 2001), the nearest in front."""
    flat, depth = centres @ camera[:, :2], centres @ camera[:, 2]
    inverse = np.linalg.inv(camera[:, :2].T @ spreads @ camera[:, :2])
    span = np.linspace(-1.5, 1.5, PIXELS)
    pixels = np.stack(np.meshgrid(span, span), axis=-1).reshape(-1, 2)
    picture, left = np.zeros((len(pixels), 3)), np.ones(len(pixels))
    for i in np.argsort(depth):
        away = pixels - flat[i]
        alpha = opacities[i] * np.exp(-0.5 * np.einsum("pi,ij,pj->p", away, inverse[i], away))
        picture += (left * alpha)[:, None] * colours[i]
        left *= 1 - alpha
    return picture.reshape(PIXELS, PIXELS, 3)


def view_of_ply(table, camera, places):
    """With colours that depend on the way of the view."""
    names = [[f"f_rest_{c * 15 + i}" for i in range(15)] for c in range(3)]
    rest = np.array([[table[name] for name in own] for own in names]).astype(float)
    own = np.array([table[f"f_dc_{c}"] for c in range(3)]).T * 0.28209479177387814
    colours = 0.5 + own + np.einsum("cin,i->nc", rest, lobe_basis(camera[:, 2])[1:])
    opacities = 1 / (1 + np.exp(-table["opacity"].astype(float)))
    return rendered(places, covariances(table) * 0.01, np.clip(colours, 0, 1), opacities, camera)


def view_of_splat(table, camera):
    turns = (table["rotation"].astype(float) - 128) / 128
    columns = {f"rot_{i}": turns[:, i] for i in range(4)}
    columns |= {f"scale_{i}": np.log(table["scale"][:, i]) for i in range(3)}
    colours = table["colour"] / 255.0
    places = table["position"].astype(float)
    return rendered(places, covariances(columns), colours[:, :3], colours[:, 3], camera)


FLIP = np.eye(3) - 2 * np.outer(PLANE.normal, PLANE.normal)


def about_the_plane(points):
    return points + PLANE.offset * PLANE.normal


def test_mirrored_views_of_reflected_splats_in_ply_are_the_same(tmp_path):
    source = write(tmp_path / "half.ply", splats(150, one_side=True))
    symsurf.complete(source, PLANE, search=False).save(tmp_path / "whole.ply")
    table = read(tmp_path / "whole.ply")[1]
    places = about_the_plane(np.column_stack([table[axis] for axis in "xyz"]).astype(float))
    own = view_of_ply(table[:150], CAMERA, places[:150])
    image = view_of_ply(table[150:], FLIP @ CAMERA, places[150:])
    same_camera = view_of_ply(table[150:], CAMERA, places[150:])
    assert np.abs(image - own).max() < 0.01 < np.abs(same_camera - own).max()


def splat_table(count=200, one_side=False):
    rng = np.random.default_rng(3)
    local = rng.normal(size=(count, 3)) * (0.5, 0.4, 0.3)
    if one_side:
        local[:, 0] = np.abs(local[:, 0]) + 0.1
    table = np.zeros(count, SPLAT)
    table["position"] = local @ TURN.T - PLANE.offset * PLANE.normal
    table["scale"] = np.exp(rng.normal(size=(count, 3)) * 0.5 - 2)
    table["colour"] = rng.integers(20, 256, (count, 4))
    turns = rng.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    table["rotation"] = np.clip(np.round(128 * turns + 128), 0, 255)
    return table


@pytest.fixture
def half(tmp_path):
    table = splat_table(one_side=True)
    (tmp_path / "half.splat").write_bytes(table.tobytes())
    return table


def test_mirrored_views_of_reflected_splats_are_the_same(half, tmp_path):
    symsurf.complete(tmp_path / "half.splat", PLANE, search=False).save(tmp_path / "whole.splat")
    whole = np.frombuffer((tmp_path / "whole.splat").read_bytes(), SPLAT).copy()
    np.testing.assert_array_equal(whole[:200], half)
    whole["position"] = about_the_plane(whole["position"])
    own, image = view_of_splat(whole[:200], CAMERA), view_of_splat(whole[200:], FLIP @ CAMERA)
    assert np.abs(image - own).mean() < 0.01 * own.mean()
    assert np.abs(view_of_splat(whole[200:], CAMERA) - own).mean() > 0.05 * own.mean()


def test_splats_reflected_twice_are_themselves_to_their_quantum(half, tmp_path):
    """The images alone, completed over the same plane, have the splats for images."""
    file = tmp_path / "half.splat"
    symsurf.complete(file, PLANE, search=False).save(tmp_path / "whole.splat")
    images = np.frombuffer((tmp_path / "whole.splat").read_bytes(), SPLAT)[200:]
    (tmp_path / "images.splat").write_bytes(images.tobytes())
    symsurf.complete(tmp_path / "images.splat", PLANE, search=False).save(tmp_path / "again.splat")
    again = np.frombuffer((tmp_path / "again.splat").read_bytes(), SPLAT)[200:]
    np.testing.assert_allclose(again["position"], half["position"], atol=1e-6)
    np.testing.assert_allclose(again["scale"], half["scale"], rtol=1e-5)
    np.testing.assert_array_equal(again["colour"], half["colour"])
    # Twice rounded, of lengths that bytes hold to a hundredth.
    off = np.abs(again["rotation"].astype(int) - half["rotation"])
    assert np.minimum(off, 256 - off).max() <= 2


@pytest.mark.parametrize("operation", ["align", "symmetrize", "complete", "cut"])
def test_splats_keep_their_format(operation, tmp_path):
    table = splat_table()
    (tmp_path / "scene.splat").write_bytes(table.tobytes())
    options = {"search": False} if operation == "complete" else {}
    made = getattr(symsurf, operation)(tmp_path / "scene.splat", PLANE, **options)
    made.save(tmp_path / "made.splat")
    rows = np.frombuffer((tmp_path / "made.splat").read_bytes(), SPLAT)
    np.testing.assert_allclose(rows["position"], made.shape.points, rtol=1e-6, atol=1e-6)
    np.testing.assert_array_equal(rows["colour"], table["colour"][made.sources])
    shape = symsurf.read(tmp_path / "scene.splat")
    np.testing.assert_array_equal(shape.weights, table["colour"][:, 3] / 255)


def test_a_file_that_is_no_splat_is_refused(tmp_path):
    (tmp_path / "cut.splat").write_bytes(bytes(70))
    with pytest.raises(symsurf.InvalidInput, match="70 bytes; allowed is a multiple of 32"):
        symsurf.read(tmp_path / "cut.splat")


def surface(count):
    rng = np.random.default_rng(5)
    d = rng.normal(size=(count, 3))
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    radius = 1 + 0.25 * np.sin(3 * d[:, 1] + 0.5) + 0.2 * d[:, 2]
    return d * radius[:, None] * (1, 0.9, 0.7)


def test_faint_splats_hardly_count(tmp_path):
    """Fog on one side, of an opacity of 2 %, hides the mirror of points that all count alike."""
    table = np.zeros(8000, SPLAT)
    table["position"] = surface(8000)
    table["position"][::4] = np.random.default_rng(6).uniform(0, 1.5, (2000, 3))
    table["colour"][:, 3] = 255
    table["colour"][::4, 3] = 5
    file = tmp_path / "fog.splat"
    file.write_bytes(table.tobytes())
    found = symsurf.detect(file, "plane")
    assert found.verdict == "found" and abs(found.mirror.normal[0]) > np.cos(np.radians(0.5))
    assert 0.95 * 2000 < found.statistics["faint_points"] < 2000
    assert "nonfinite_points" not in symsurf.detect(file, "plane").summary
    alike = symsurf.detect(table["position"].astype(float), "plane")
    assert alike.score < found.score
    aligned = symsurf.align(file, method="plane")
    np.testing.assert_array_equal(aligned.mirror.normal, found.mirror.normal)
    with pytest.raises(symsurf.InvalidInput, match=r"allowed is one number in \[0, 1\] per point"):
        symsurf.detect(table["position"], weights=np.ones(3))


def test_the_opacity_of_splats_in_ply_are_weights(tmp_path):
    rows = splats(300)
    shape = symsurf.read(write(tmp_path / "scene.ply", rows))
    opacity = rows[:, NAMES.index("opacity")]
    np.testing.assert_allclose(shape.weights, 1 / (1 + np.exp(-opacity.astype(float))))
    assert symsurf.read(write(tmp_path / "plain.ply", rows[:, :3], ["x", "y", "z"])).weights is None
