"""Bad input is refused with an error that names what was given and what is allowed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import symsurf

GOOD = np.random.default_rng(0).normal(size=(50, 3))


def with_value(value):
    points = GOOD.copy()
    points[17, 1] = value
    return points


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (GOOD[:, :2], r"\(50, 2\).*\(n, 3\)"),
        (GOOD.T, r"\(3, 50\).*\(n, 3\)"),
        (GOOD[None], r"\(1, 50, 3\).*\(n, 3\)"),
        (GOOD[0], r"\(3,\).*\(n, 3\)"),
        (None, r"points are of type NoneType; allowed are an array .*\(n, 3\), the name of a file"),
        (7, "points are of type int; allowed are"),
        (symsurf.Plane((0, 0, 1), 0), "points are of type Plane; allowed are"),
        (b"points.ply", "points are of type bytes; allowed are"),
        (np.float64(7), r"type float64.*\(n, 3\)"),
        ("points.ply", "points.ply: there is no such file"),
        ([], r"\(0,\).*\(n, 3\)"),
        ([[1, 2, 3], [1, 2]], "array"),
        (GOOD.astype(complex), "complex128.*real"),
        (GOOD.astype(str), "<U.*real"),
        (np.full((50, 3), object()), "real numbers"),
        (np.full((50, 3), None), "0 of 50 points given are finite"),
        (np.ma.masked_less(GOOD, 0), "masked"),
        (GOOD[:0], "0 points.*at least"),
        (GOOD[:3], "3 points.*at least"),
        (np.ones((50, 3)), "50 points are equal"),
        (np.outer(np.arange(50), (1, 2, 3)), "one line"),
    ],
)
@pytest.mark.parametrize("method", ["auto", "plane"])
def test_points(points, says, method):
    with pytest.raises(symsurf.InvalidInput, match=says):
        symsurf.detect(points, method)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_points_that_are_not_finite_where_that_is_refused(value):
    for call in (
        lambda: symsurf.detect(with_value(value), nonfinite="refuse"),
        lambda: symsurf.detect_plane(with_value(value), nonfinite="refuse"),
        lambda: symsurf.match(with_value(value), symsurf.Plane((0, 0, 1), 0), nonfinite="refuse"),
    ):
        with pytest.raises(symsurf.InvalidInput, match=f"point 17 is .*{value}.*finite"):
            call()


@pytest.mark.parametrize(
    ("faces", "says"),
    [
        ([[0, 1, 50]], "face 0 names point 50; allowed is 0 to 49"),
        ([[0, 1, 2], [3, -1, 4]], "face 1 names point -1; allowed is 0 to 49"),
        ([[0, 1, 2, 3]], r"faces have shape \(1, 4\); allowed is \(m, 3\)"),
        ([0, 1, 2], r"faces have shape \(3,\); allowed is \(m, 3\)"),
        ([[0.0, 1.0, 2.0]], "faces are of type float64; allowed are whole numbers"),
    ],
)
def test_faces(faces, says):
    with pytest.raises(symsurf.InvalidInput, match=says):
        symsurf.detect(GOOD, faces=faces)


@pytest.mark.parametrize(
    ("normals", "says"),
    [
        (GOOD[:10], "10 normals.*50 points"),
        (GOOD[:, :2], r"normals.*\(50, 2\).*\(n, 3\)"),
        (with_value(np.nan), "normal 17.*finite"),
        (np.zeros((50, 3)), r"normal 0 is \(0, 0, 0\)"),
    ],
)
def test_normals(normals, says):
    with pytest.raises(symsurf.InvalidInput, match=says):
        symsurf.detect(GOOD, normals=normals)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"method": "magic"}, "'magic'.*auto, plane"),
        ({"method": None}, "'None'.*auto, plane"),
        ({"wrong": 1}, "'auto'.*'wrong'"),
        ({"threads": -1}, r"threads is -1.*\[0, "),
        ({"threads": 1.5}, r"threads is 1.5.*whole"),
        ({"seed": -1}, r"seed is -1.*\[0, "),
        ({"seed": 2**64}, rf"seed is {2**64}.*\[0, "),
        ({"seed": "a"}, "seed is 'a'.*whole"),
        ({"progress": 3}, "progress is 3.*function"),
        ({"nonfinite": "drop"}, "nonfinite is 'drop'; allowed is 'skip' or 'refuse'"),
        ({"threshold": 1.0}, "threshold is 1.0; allowed is None, as the input is no grid"),
        ({"scalars": "a"}, "scalars is 'a'; allowed is None, as the input is no grid"),
    ],
)
def test_options(options, says):
    with pytest.raises(symsurf.InvalidParameter, match=says):
        symsurf.detect(GOOD, **options)


def out_of_range():
    for method in symsurf.methods().values():
        for parameter in method.parameters:
            bad = [None, object(), [], [1.0, 2.0]]
            if parameter.type in ("integer", "real"):
                bad += ["text", np.nan, (0, 0, 1), 10**400, -(10**400)]
                bad += [parameter.minimum - 1] if np.isfinite(parameter.minimum) else []
                bad += [parameter.maximum + 1] if np.isfinite(parameter.maximum) else []
            if parameter.type == "integer":
                bad += [10**30, 1.5]
            if parameter.type == "choice":
                bad += ["neither", 1]
            if parameter.type == "boolean":
                bad += [1, "true"]
            if parameter.type in ("direction", "position"):
                bad += ["up", 1.0, (0, 0, np.nan)]
            for value in bad:
                name = f"{method.name}-{parameter.name}-{type(value).__name__}"
                yield pytest.param(method.name, parameter, value, id=name)


@pytest.mark.parametrize(("method", "parameter", "value"), list(out_of_range()))
def test_parameters(method, parameter, value):
    with pytest.raises(symsurf.InvalidParameter) as error:
        symsurf.detect(GOOD, method, **{parameter.name: value})
    assert parameter.name in str(error.value)
    assert parameter.range in str(error.value)


def test_mirrors():
    with pytest.raises(symsurf.InvalidInput, match=r"\(0, 0, 0\)"):
        symsurf.Plane((0, 0, 0), 1)
    with pytest.raises(symsurf.InvalidInput, match=r"\(2,\).*\(3,\)"):
        symsurf.Plane((0, 1), 1)
    with pytest.raises(symsurf.InvalidInput, match="inf"):
        symsurf.Plane((0, 0, 1), np.inf)
    with pytest.raises(symsurf.InvalidInput, match="-1"):
        symsurf.Sphere((0, 0, 0), -1)
    plane = symsurf.Plane((0, 0, 1), 1)
    with pytest.raises(symsurf.InvalidInput, match="by hand"):
        plane.mesh()
    with pytest.raises(symsurf.InvalidParameter, match="resolution is 0"):
        plane.mesh(GOOD, resolution=0)
    with pytest.raises(symsurf.InvalidInput, match=r"\(50, 2\)"):
        plane.reflect(GOOD[:, :2])
    with pytest.raises(symsurf.InvalidParameter, match="pair_distance is -1"):
        symsurf.match(GOOD, plane, pair_distance=-1)


def test_sampling():
    with pytest.raises(symsurf.InvalidParameter):
        symsurf.downsample(GOOD, 0)
    with pytest.raises(symsurf.InvalidParameter):
        symsurf.estimate_normals(GOOD, neighbours=2)
    with pytest.raises(symsurf.InvalidParameter):
        symsurf.estimate_normals(GOOD, method="magic")
    with pytest.raises(symsurf.InvalidInput):
        symsurf.estimate_normals(GOOD[:5], neighbours=10)


@pytest.mark.parametrize("seed", [-1, 1.5, "a", 2**64])
def test_seeds_of_damage(seed):
    for damage in (
        lambda: symsurf.synthetic.add_noise(GOOD, 0, 1, seed=seed),
        lambda: symsurf.synthetic.remove_points(GOOD, 0.5, seed=seed),
        lambda: symsurf.synthetic.thin(GOOD, seed=seed),
    ):
        with pytest.raises(symsurf.InvalidParameter, match=rf"seed is '?{seed}'?; allowed is"):
            damage()


@pytest.mark.parametrize("tolerance", [0, -0.1, np.nan])
def test_coverage(tolerance):
    plane = symsurf.Plane((0, 0, 1), 0)
    with pytest.raises(symsurf.InvalidParameter, match=rf"tolerance is {tolerance}.*\(0, inf\)"):
        symsurf.metrics.coverage(GOOD, plane, GOOD, tolerance)


def test_the_errors_are_value_errors():
    assert issubclass(symsurf.InvalidInput, ValueError)
    assert issubclass(symsurf.InvalidParameter, ValueError)
    assert not issubclass(symsurf.Cancelled, ValueError)


SPHERE = symsurf.Sphere((0, 0, 0), 5)
TAKE_A_MIRROR = {
    "match": ("mirror", lambda mirror: symsurf.match(GOOD, mirror).residuals),
    "bend": ("mirror", lambda mirror: symsurf.bend(GOOD, mirror)),
    "straight_mirror": ("mirror", lambda mirror: symsurf.straight_mirror(mirror, GOOD).numbers),
    "asymmetry": ("mirror", lambda mirror: symsurf.asymmetry(GOOD, mirror or 0).distance),
    "coverage": ("truth", lambda mirror: symsurf.metrics.coverage(GOOD, mirror, GOOD)),
    "surface_distance": (
        "truth",
        lambda mirror: symsurf.metrics.surface_distance(GOOD, mirror, GOOD),
    ),
    "sphere_errors": ("found", lambda mirror: symsurf.metrics.sphere_errors(mirror, SPHERE, GOOD)),
}


@pytest.mark.parametrize("name", TAKE_A_MIRROR)
def test_a_result_stands_for_its_mirror(name):
    argument, call = TAKE_A_MIRROR[name]
    np.testing.assert_equal(call(symsurf.match(GOOD, SPHERE)), call(SPHERE))
    without = replace(symsurf.match(GOOD, SPHERE), mirror=None)
    with pytest.raises(symsurf.InvalidInput, match="the result of match has no mirror"):
        call(without)
    with pytest.raises(
        symsurf.InvalidParameter,
        match=f"{argument} is of type .*; allowed is a Result, a Mirror or a plane",
    ):
        call(None)


def test_errors_of_spheres_of_other_mirrors():
    plane = symsurf.Plane((0, 0, 1), 0)
    with pytest.raises(symsurf.InvalidParameter, match="truth is a plane; allowed is a sphere"):
        symsurf.metrics.sphere_errors(SPHERE, plane, GOOD)
