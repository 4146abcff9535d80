"""Columns with directions, and Gaussian splats, in files that operations rewrite."""

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import random_rotation
from symsurf._core import AttributeTransform

import symsurf
from symsurf.shapes.kinds import turned

TURN = random_rotation(np.random.default_rng(2))
PLANE = symsurf.Plane(TURN[:, 0], 0.1)
SPLAT = [
    *("x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"),
    *(f"f_rest_{i}" for i in range(45)),
    *("opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"),
]
ROTATION, HARMONICS = (slice(SPLAT.index(name), None) for name in ("rot_0", "f_rest_0"))
HARMONICS = slice(HARMONICS.start, HARMONICS.start + 45)


def splats(count, one_side=False):
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(count, len(SPLAT)))
    local = rng.normal(size=(count, 3)) * (1, 0.8, 0.6)
    if one_side:
        local[:, 0] = np.abs(local[:, 0]) + 0.1
    rows[:, :3] = local @ TURN.T + 0.1 * TURN[:, 0]
    return rows.astype("<f4")


def write(path, rows, names=SPLAT, kind="float"):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
    header += "".join(f"property {kind} {name}\n" for name in names) + "end_header\n"
    path.write_bytes(header.encode() + rows.tobytes())
    return path


def read(path):
    """The header's lines of properties, and the rows."""
    header, _, body = path.read_bytes().partition(b"end_header\n")
    properties = [line for line in header.decode().splitlines() if line.startswith("property")]
    kinds = {"float": "<f4", "double": "<f8", "int": "<i4"}
    fields = [(name, kinds[kind]) for _, kind, name in map(str.split, properties)]
    return properties, np.frombuffer(body, fields)


def rows_of(table):
    return np.column_stack([table[name] for name in SPLAT]).astype(float)


def test_aligned_splats_turn_and_keep_types_order_and_all_else(tmp_path):
    rows = splats(500)
    source = write(tmp_path / "scene.ply", rows)
    made = symsurf.align(source, PLANE)
    made.save(tmp_path / "aligned.ply")
    properties, table = read(tmp_path / "aligned.ply")
    assert properties == [f"property float {name}" for name in SPLAT]
    aligned, turn = rows_of(table), made.matrix[:3, :3]
    np.testing.assert_allclose(aligned[:, :3], made.shape.points, atol=1e-6)
    np.testing.assert_allclose(aligned[:, 3:6], rows[:, 3:6] @ turn.T, atol=1e-6)
    for kind, columns in (("quaternion", ROTATION), ("harmonics", HARMONICS)):
        wanted = turned(rows[:, columns].astype(float), kind, turn)
        np.testing.assert_allclose(aligned[:, columns], wanted, atol=1e-6)
    others = [i for i, name in enumerate(SPLAT) if name[0] in "os" or name.startswith("f_dc")]
    np.testing.assert_array_equal(aligned[:, others].astype("f4"), rows[:, others])


def test_images_of_splats_reflected_again_are_these(tmp_path):
    rows = splats(300, one_side=True)
    source = write(tmp_path / "half.ply", rows)
    symsurf.complete(source, PLANE, search=False).save(tmp_path / "whole.ply")
    _, table = read(tmp_path / "whole.ply")
    whole = np.column_stack([table[name] for name in SPLAT if name[0] != "n"])
    names = [name for name in SPLAT if name[0] != "n"]
    own, images = whole[:300], whole[300:]
    assert len(images) == 300
    flip = np.eye(3) - 2 * np.outer(PLANE.normal, PLANE.normal)
    for kind, first, count in (("quaternion", "rot_0", 4), ("harmonics", "f_rest_0", 45)):
        columns = slice(names.index(first), names.index(first) + count)
        again = turned(images[:, columns].astype(float), kind, flip)
        np.testing.assert_array_equal(own[:, columns], rows[:, SPLAT.index(first) :][:, :count])
        np.testing.assert_allclose(again, own[:, columns], atol=1e-6)
        assert np.abs(images[:, columns] - own[:, columns]).max() > 0.1


def covariances(table):
    w, x, y, z = (table[f"rot_{i}"].astype(float) for i in range(4))
    size = w * w + x * x + y * y + z * z
    rows = [
        [size - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), size - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), size - 2 * (x * x + y * y)],
    ]
    turns = (np.array(rows) / size).transpose(2, 0, 1)
    squares = np.exp(2 * np.column_stack([table[f"scale_{i}"] for i in range(3)]).astype(float))
    return turns @ (squares[:, :, None] * np.swapaxes(turns, 1, 2))


@pytest.mark.parametrize(
    "mirror", [PLANE, symsurf.Sphere(-4 * TURN[:, 0], 4)], ids=["plane", "sphere"]
)
def test_images_of_ellipsoids_are_those_of_the_local_map(mirror, tmp_path):
    source = write(tmp_path / "half.ply", splats(300, one_side=True))
    symsurf.complete(source, mirror, search=False).save(tmp_path / "whole.ply")
    _, table = read(tmp_path / "whole.ply")
    own, images = table[:300], table[300:]
    points = np.column_stack([own[axis] for axis in "xyz"]).astype(float)
    local = AttributeTransform(mirror, points).jacobians
    wanted = local @ covariances(own) @ np.swapaxes(local, 1, 2)
    np.testing.assert_allclose(covariances(images), wanted, rtol=1e-4, atol=1e-5 * wanted.max())
    assert len(images) == 300


@pytest.mark.parametrize("suffix", [".ply", ".csv"])
def test_the_command_line_turns_vectors_and_names_what_it_does_not(suffix, tmp_path):
    rows = splats(200)[:, :9].astype(float)
    names = ["x", "y", "z", "wind_x", "wind_y", "wind_z", "curl_x", "curl_y", "curl_z"]
    source = tmp_path / f"points{suffix}"
    if suffix == ".ply":
        write(source, rows, names, "double")
    else:
        np.savetxt(source, rows, "%.17g", delimiter=",", header=",".join(names), comments="")
    options = "--vector wind --method plane --vector nothing"
    told = run_here(f"align points{suffix} -o out{suffix} {options}", tmp_path)
    assert told.returncode == 0, told.stderr
    assert "curl is not turned" in told.stderr and "wind is" not in told.stderr
    assert "nothing, given as vector, is not in the file" in told.stderr
    made = symsurf.align(source, kinds={"wind": "vector"}, method="plane")
    turn = made.matrix[:3, :3]
    out = tmp_path / f"out{suffix}"
    table = read(out)[1] if suffix == ".ply" else np.genfromtxt(out, delimiter=",", names=True)
    wind, curl = (np.column_stack([table[f"{n}_{a}"] for a in "xyz"]) for n in ("wind", "curl"))
    np.testing.assert_allclose(wind, rows[:, 3:6] @ turn.T, atol=1e-12)
    np.testing.assert_array_equal(curl, rows[:, 6:])


def test_active_normals_go_along_but_where_points_move_each_by_itself():
    pyvista = pytest.importorskip("pyvista")
    given = pyvista.Sphere().compute_normals(split_vertices=False)
    given.points[:, 0] += 0.2
    assert given.point_data.active_normals_name == "Normals"
    for operation in (symsurf.align, symsurf.complete, symsurf.cut, symsurf.asymmetry):
        made = operation(given, "z=0.1").like(given)
        name = made.point_data.active_normals_name
        assert name == "Normals", operation
        normals = made.point_data[name]
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
        # The normals of a sphere point away from its centre.
        if operation is symsurf.align:
            away = made.points - made.points.mean(axis=0)
            assert (np.sum(away * normals, axis=1) > 0.49).all()
    made = symsurf.symmetrize(given, "z=0.1").like(given)
    assert made.point_data.active_normals_name is None and "Normals" not in made.point_data


def test_tables_turn_the_columns_of_vectors_and_keep_their_types():
    pandas = pytest.importorskip("pandas")
    rows = splats(200)[:, :9].astype(float)
    names = ["x", "y", "z", "wind_x", "wind_y", "wind_z", "curl_x", "curl_y", "curl_z"]
    given = pandas.DataFrame(rows, columns=names).astype({"x": "f4"})
    made = symsurf.align(given, PLANE, kinds={"wind": "vector"})
    with pytest.warns(symsurf.InputWarning, match="curl is not turned"):
        turned = made.like(given)
    np.testing.assert_allclose(turned[names[3:6]], rows[:, 3:6] @ made.matrix[:3, :3].T, atol=1e-12)
    assert list(turned.columns) == names and turned.dtypes.equals(given.dtypes)
