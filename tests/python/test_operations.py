"""What is done with a mirror, from Python."""

import ast
import dataclasses
import inspect
import json
import re
from importlib import resources

import numpy as np
import pytest
import pyvista
from command_line import run_here
from symmetric_shapes import lopsided_blob

import symsurf
from symsurf.mirror_operations.operate import operate

RESULTS = {
    "asymmetry": symsurf.Asymmetry,
    "correspondences": symsurf.Correspondences,
    "align": symsurf.Alignment,
    "complete": symsurf.Completed,
    "symmetrize": symsurf.Symmetrized,
    "straighten": symsurf.Straightened,
    "remesh": symsurf.Remeshed,
    "cut": symsurf.Half,
    "transfer": symsurf.Transferred,
    "illuminate": symsurf.Illuminated,
}
RESULTS = {name: RESULTS[name] for name in symsurf.operations()}
PLANE = symsurf.Plane((1, 0, 0), 0)


@pytest.fixture
def ball():
    """A sphere's mesh with a dent on the positive side, and how deep it is at each point."""
    mesh = pyvista.Icosphere(radius=1, nsub=4)
    points = np.array(mesh.points, dtype=float)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    off = ((points - np.array([0.8, 0.6, 0])) ** 2).sum(axis=1) / 0.2
    depth = np.where(off < 1, 0.05 * (1 - off) ** 2, 0)
    return symsurf.Shape(points * (1 - depth)[:, None], mesh.regular_faces), depth


@pytest.mark.parametrize("name", RESULTS)
def test_each_has_a_function_and_a_result_as_described(name):
    operation, function = symsurf.operations()[name], getattr(symsurf, name)
    assert operation.summary and operation.title
    fields = {each.name for each in dataclasses.fields(RESULTS[name])}
    assert {array.name for array in operation.arrays + operation.face_arrays} <= fields
    assert RESULTS[name].operation == name
    shown = inspect.signature(function).parameters
    first = ["values"] if operation.carries_values else []
    assert list(shown)[: len(first) + 2] == [*first, "shape", "mirror"]
    assert ("mask" in shown) == operation.takes_mask
    documentation = " ".join(function.__doc__.split())
    assert operation.summary in documentation
    for parameter in operation.parameters:
        default = shown[parameter.name].default
        np.testing.assert_array_equal(default, parameter.default)
        sentence = f"{parameter.name}: {parameter.doc} Allowed: {parameter.allowed}."
        assert sentence in documentation
    assert all(f"{word}:" in documentation or f"{word}," in documentation for word in shown)
    stubs = ast.parse(str_of("mirror_operations/functions.pyi"))
    (stub,) = (node for node in stubs.body if getattr(node, "name", "") == name)
    assert [each.arg for each in stub.args.args + stub.args.kwonlyargs] == list(shown)
    assert ast.unparse(stub.returns) == RESULTS[name].__name__


def str_of(file):
    return (resources.files("symsurf") / file).read_text()


@pytest.mark.parametrize("name", RESULTS)
def test_arrays_have_the_type_and_shape_described(name, ball):
    shape, _ = ball
    result = operate(name, shape, PLANE)
    assert isinstance(result, RESULTS[name])
    if not result.is_other:
        assert len(result.shape.points) == len(shape.points)
        np.testing.assert_array_equal(result.shape.faces, shape.faces)
    for array in symsurf.operations()[name].face_arrays:
        assert getattr(result, array.name).shape == (len(result.shape.faces),)
    for array in symsurf.operations()[name].arrays:
        if getattr(result, array.name) is None:  # of mirrored triangles and homologous points alone
            assert (
                array.name in {"symmetrize": ["partner"], "asymmetry": ["vector_sd", "known"]}[name]
            )
            continue
        values = getattr(result, array.name)
        kind = {"real": "f", "integer": "i", "boolean": "b"}[array.type]
        assert values.dtype.kind == kind
        rows = (len(result.shape.points),)
        assert values.shape == (rows if array.components == 1 else (*rows, array.components))
    if not symsurf.operations()[name].moves_points:
        np.testing.assert_array_equal(result.shape.points, shape.points)


def test_asymmetry_is_the_dent(ball):
    shape, depth = ball
    result = symsurf.asymmetry(shape, PLANE)
    deepest = depth.argmax()
    assert result.signed[deepest] == pytest.approx(depth[deepest], rel=0.02)
    assert result.statistics["maximum"] == pytest.approx(depth[deepest], rel=0.02)
    assert result.statistics["volume_index"] < 0  # less on the positive side
    elsewhere = (depth == 0) & (depth[symsurf.correspondences(shape, PLANE).index] == 0)
    assert result.distance[elsewhere].max() < 1e-3 * result.statistics["diagonal"]


def test_the_mirror_is_found_first(ball):
    shape, _ = ball
    assert symsurf.asymmetry(shape).mirror.kind == "plane"
    found = symsurf.detect(shape)
    np.testing.assert_array_equal(
        symsurf.asymmetry(shape, found).distance, symsurf.asymmetry(shape, found.mirror).distance
    )


def test_align_moves_the_mirror_to_the_axis(ball):
    shape, _ = ball
    turned = symsurf.synthetic.rotate(shape.points, 10, 20, 30) + [5, 6, 7]
    normal = symsurf.synthetic.rotate(np.array([[1.0, 0, 0]]), 10, 20, 30)[0]
    mirror = symsurf.Plane(normal, -normal @ [5, 6, 7])
    result = symsurf.align(turned, mirror, axis="y")
    assert np.linalg.det(result.matrix[:3, :3]) == pytest.approx(1)
    homogeneous = np.c_[turned, np.ones(len(turned))]
    moved = (homogeneous @ result.matrix.T)[:, :3]
    np.testing.assert_allclose(moved, result.shape.points, atol=1e-12)
    left = symsurf.asymmetry(result.shape.points, symsurf.Plane((0, 1, 0), 0))
    np.testing.assert_allclose(
        left.statistics["rms"], symsurf.asymmetry(turned, mirror).statistics["rms"], rtol=1e-6
    )


def test_symmetrize_leaves_nothing_and_heeds_the_mask(ball):
    shape, depth = ball
    even = symsurf.symmetrize(shape, PLANE, side="negative")
    assert symsurf.asymmetry(even.shape, PLANE).statistics["maximum"] < 1e-9
    np.testing.assert_allclose(np.linalg.norm(even.shape.points, axis=1), 1, atol=1e-9)
    nothing = symsurf.symmetrize(shape, PLANE, mask=np.zeros(len(depth), bool))
    np.testing.assert_array_equal(nothing.shape.points, shape.points)


def test_straighten_goes_there_and_back(ball):
    shape, _ = ball
    mirror = symsurf.detect_cylinder(
        symsurf.bend(shape.points, symsurf.Cylinder((-3, 0, 0), (0, 1, 0), 3), back=True)
    ).mirror
    bent = mirror.project(shape.points)
    straight = symsurf.straighten(bent, mirror)
    back = symsurf.straighten(straight.shape, mirror, back=True)
    np.testing.assert_allclose(back.shape.points, bent, atol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "error", "says"),
    [
        ({"result": 3}, symsurf.InvalidParameter, "mirror is of type int"),
        ({"max_angle": 200}, symsurf.InvalidParameter, "max_angle"),
        ({"speed": 1}, symsurf.InvalidParameter, "speed"),
        ({"result": symsurf.Sphere((0, 0, 0), 0.01)}, symsurf.InvalidInput, "have an image"),
        ({"faces": [[0, 1, 10**6]]}, symsurf.InvalidInput, "face 0 names point 1000000"),
    ],
)
def test_what_is_wrong_is_named(ball, arguments, error, says):
    shape, _ = ball
    with pytest.raises(error, match=says):
        symsurf.asymmetry(shape.points, **({"result": PLANE} | arguments))


def test_a_mask_must_fit(ball):
    shape, depth = ball
    for mask in (np.ones(3), np.ones((len(depth), 2)), 2 * np.ones(len(depth)), "all"):
        with pytest.raises(symsurf.InvalidInput, match="mask"):
            symsurf.symmetrize(shape, PLANE, mask=mask)


def test_a_mirror_in_another_unit_is_named(ball):
    shape, _ = ball
    placed = symsurf.Shape(shape.points + (50, 0, 0), shape.faces)
    mirror = symsurf.Plane((1, 0, 0), -50)
    in_millimetres = symsurf.Shape(1000 * placed.points, shape.faces)
    for name in RESULTS:
        operate(name, placed, mirror)
        if symsurf.operations()[name].takes_any_mirror:
            continue
        with pytest.raises(symsurf.InvalidInput, match="diagonals away .* unit"):
            operate(name, in_millimetres, mirror)


@pytest.mark.parametrize("name", RESULTS)
def test_what_it_says_of_itself(name, ball):
    shape, _ = ball
    result = operate(name, shape, PLANE)
    assert repr(result).startswith(f"{RESULTS[name].__name__}(Shape({len(result.shape.points)} ")
    text, table = str(result), result._repr_html_()
    for each in ("operation", name, "plane", *result.summary, *result.summary.values()):
        assert each.split("\n")[0] in text
    assert table.count("<tr>") == len(result.summary)
    for figure, value in result.statistics.items():
        words = figure.removesuffix("_of_diagonal").replace("_", " ")
        assert words in text or (figure.startswith("unmatched_") and value == 0)


def test_only_what_is_unmatched_is_told(ball, tmp_path):
    """In Python and by the command line."""
    shape, _ = ball
    whole = symsurf.asymmetry(shape, PLANE)
    assert whole.statistics["unmatched_share"] == 0 and "unmatched" not in str(whole)
    part = symsurf.asymmetry(shape, PLANE, max_distance=1e-6)
    share = part.statistics["unmatched_too_far"]
    assert 0 < share == part.statistics["unmatched_share"]
    told = {name: text for name, text in part.summary.items() if "unmatched" in name}
    expected = f"{int(1000 * share) / 10:g} %"
    assert told == {"unmatched share": expected, "unmatched too far": expected}
    np.savetxt(tmp_path / "blob.xyz", lopsided_blob(2000))
    line = "asymmetry blob.xyz --method plane --max-distance 0.05"
    record = json.loads(run_here(f"{line} --json", tmp_path).stdout)
    shares = {name: share for name, share in record["statistics"].items() if "unmatched" in name}
    assert shares["unmatched_without_image"] == 0 < shares["unmatched_too_far"]
    printed = re.findall(r"unmatched [a-z ]*[a-z]", run_here(line, tmp_path).stdout)
    assert set(printed) == {name.replace("_", " ") for name, share in shares.items() if share > 0}


def test_lengths_are_told_with_their_share(ball):
    shape, _ = ball
    result = symsurf.asymmetry(shape, PLANE)
    share = 100 * result.statistics["rms_of_diagonal"]
    assert f"({share:.3f} % of the diagonal)" in result.summary["rms"]


@pytest.mark.parametrize("name", RESULTS)
@pytest.mark.parametrize("is_mesh", [True, False], ids=["mesh", "cloud"])
def test_tables_have_a_row_a_point(name, is_mesh, ball, tmp_path):
    if symsurf.operations()[name].needs_faces and not is_mesh:
        pytest.skip("takes meshes alone")
    shape, _ = ball
    result = operate(name, shape if is_mesh else shape.points, PLANE)
    result.save(tmp_path / "table.npy")
    rows = np.load(tmp_path / "table.npy")
    assert list(rows.dtype.names or ()) == list(result.arrays)
    result.save(tmp_path / "table.csv")
    first, *lines = (tmp_path / "table.csv").read_text().splitlines()
    result.save(tmp_path / "table.json")
    record = json.loads((tmp_path / "table.json").read_text())
    assert record["operation"] == name and record["mirror"]["kind"] == "plane"
    assert set(record["statistics"]) == set(result.statistics)
    if not result.arrays:
        assert not lines
        return
    table = np.array([line.split(",") for line in lines], float)
    columns = [each.reshape(len(table), -1) for each in result.arrays.values()]
    np.testing.assert_array_equal(table, np.hstack(columns).astype(float))
    assert len(first.split(",")) == table.shape[1]
    for array, values in result.arrays.items():
        np.testing.assert_array_equal(rows[array], values)
        np.testing.assert_array_equal(np.array(record["arrays"][array], values.dtype), values)


def test_a_mirror_that_is_none_warns_unless_refused():
    points = lopsided_blob(800)
    found = symsurf.detect(points)
    assert found.verdict == "none"
    with pytest.warns(symsurf.InputWarning, match="require_found") as warnings:
        first = symsurf.asymmetry(points)
    assert found.reason in str(warnings[0].message) and warnings[0].filename == __file__
    given = symsurf.asymmetry(points, found)  # nothing is found, and no warning given
    np.testing.assert_array_equal(first.distance, given.distance)
    for result in (None, found):
        with pytest.raises(symsurf.InvalidInput, match="the shape has no mirror") as error:
            symsurf.asymmetry(points, result, require_found=True)
        assert found.reason in str(error.value)
    symsurf.asymmetry(points, found.mirror, require_found=True)  # it has no verdict


def test_what_is_said_of_a_mirror_that_is_none(tmp_path):
    np.savetxt(tmp_path / "none.xyz", lopsided_blob(800))
    done = run_here("align none.xyz --json --output made", tmp_path)
    record = json.loads(done.stdout)
    assert done.returncode == 0 and record["verdict"] == "none"
    (notice,) = record["notices"]
    assert record["reason"] in notice and done.stderr == f"symsurf: none.xyz: {notice}\n"
    assert len(symsurf.read(tmp_path / "made" / "none.xyz").points) == 800
    done = run_here("align none.xyz --json --require-found --output refused", tmp_path)
    assert done.returncode == 1 and done.stdout == "" and record["reason"] in done.stderr
    assert not (tmp_path / "refused" / "none.xyz").exists()
    (row,) = symsurf.batch([tmp_path / "none.xyz"], "align", require_found=True)
    assert "has no mirror" in row["error"]


def test_save_keeps_points_faces_and_arrays(ball, tmp_path):
    shape, _ = ball
    result = symsurf.asymmetry(shape, PLANE)
    result.save(tmp_path / "ball.ply")
    again = symsurf.read(tmp_path / "ball.ply")
    np.testing.assert_array_equal(again.points, shape.points)
    np.testing.assert_array_equal(again.faces, shape.faces)
    assert b"property double distance" in (tmp_path / "ball.ply").read_bytes()
    result.save(tmp_path / "ball.vtp")
    mesh = pyvista.read(tmp_path / "ball.vtp")
    np.testing.assert_array_equal(mesh.points, shape.points)
    np.testing.assert_array_equal(mesh.regular_faces, shape.faces)
    for name, values in result.arrays.items():
        np.testing.assert_array_equal(mesh[name], values)
    symsurf.asymmetry(shape.points, PLANE).save(tmp_path / "cloud.vtp")
    assert pyvista.read(tmp_path / "cloud.vtp").n_verts == len(shape.points)
    with pytest.warns(symsurf.InputWarning, match="OBJ cannot hold the arrays vector, distance"):
        result.save(tmp_path / "ball.obj")
    with pytest.raises(symsurf.InvalidParameter, match="allowed are the suffixes .ply, .vtp"):
        result.save(tmp_path / "ball.docx")


@pytest.mark.parametrize("name", RESULTS)
def test_a_command_for_each(name, ball, tmp_path):
    shape, _ = ball
    symsurf.straighten(shape, PLANE).save(tmp_path / "ball.ply")
    done = run_here(f"{name} ball.ply --output made --format ply --json --method plane", tmp_path)
    assert done.returncode == 0, done.stderr
    record = json.loads(done.stdout)
    assert record["mirror"]["kind"] == "plane"
    made = symsurf.read(tmp_path / "made/ball.ply")
    in_python = operate(name, shape, symsurf.detect_plane(shape))
    np.testing.assert_array_equal(made.points, in_python.shape.points)
    assert set(record["statistics"]) == set(in_python.statistics)
    told = run_here(f"{name} ball.ply", tmp_path)
    for figure, value in record["statistics"].items():
        is_told = figure.removesuffix("_of_diagonal").replace("_", " ") in told.stdout
        assert is_told or (figure.startswith("unmatched_") and value == 0)


def test_commands_name_what_is_wrong(ball, tmp_path):
    shape, _ = ball
    symsurf.straighten(shape, PLANE).save(tmp_path / "ball.ply")
    for line, status, says in [
        ("align ball.ply --axis w", 2, "axis is w"),
        ("asymmetry ball.ply gone.ply", 1, "gone.ply"),
        (
            "asymmetry ball.ply --output made --format docx",
            2,
            "format is docx; allowed are input, ply, vtp",
        ),
        ("asymmetry ball.ply --output . --format ply", 2, "would overwrite an input"),
    ]:
        done = run_here(line, tmp_path)
        assert done.returncode == status
        assert says in done.stderr


def test_completion_is_the_shape_that_was_lost(ball):
    """And leaves what is there, and tells the one from the other."""
    points = ball[0].points / np.linalg.norm(ball[0].points, axis=1, keepdims=True)
    lost = (points[:, 0] > 0.2) & (points[:, 1] > -0.3)
    faces = (np.cumsum(~lost) - 1)[ball[0].faces[~lost[ball[0].faces].any(axis=1)]]
    broken = symsurf.Shape(points[~lost], faces)
    result = symsurf.complete(broken, PLANE)
    count = len(broken.points)
    np.testing.assert_array_equal(result.shape.points[:count], broken.points)
    np.testing.assert_array_equal(result.shape.faces[: len(faces)], faces)
    assert (result.origin[:count] == 0).all() and (result.origin[count:] > 0).all()
    np.testing.assert_array_equal(result.sources[:count], np.arange(count))
    added = result.shape.points[count:]
    images = PLANE.reflect(broken.points[result.sources[count:]])
    np.testing.assert_allclose(added, images, atol=0.01)
    np.testing.assert_allclose(np.linalg.norm(added, axis=1), 1, atol=0.005)
    assert len(result.face_sources) == len(result.shape.faces)
    # The patch is what was added: the same triangles, numbered anew.
    patch = result.patch
    np.testing.assert_array_equal(
        patch.points[patch.faces], result.shape.points[result.shape.faces[len(faces) :]]
    )
    assert set(np.unique(patch.faces)) == set(range(len(patch.points)))
    cloud = symsurf.complete(broken.points, PLANE)
    assert cloud.shape.faces is None and cloud.patch.faces is None
    np.testing.assert_array_equal(cloud.patch.points, cloud.shape.points[count:])
    whole = symsurf.complete(symsurf.Shape(points, ball[0].faces), PLANE)
    assert len(whole.shape.points) == len(points) and not whole.origin.any()
    assert len(whole.patch.points) == 0


def icosphere(scale=(1, 0.7, 0.5)):
    mesh = pyvista.Icosphere(radius=1, nsub=4)
    return np.asarray(mesh.points, dtype=float) * scale, mesh.regular_faces


def test_a_sculpted_side_is_carried_vertex_to_vertex():
    """However the other side lies now, the triangles tell its vertices."""
    rest, faces = icosphere()
    mirrored = rest * (-1, 1, 1)
    partner = np.array([np.linalg.norm(rest - x, axis=1).argmin() for x in mirrored])
    bump = 0.1 * np.exp(-((((rest - [0.6, 0.4, 0.1]) / 0.25) ** 2).sum(axis=1)))
    sculpted = np.where(rest[:, :1] > 1e-9, rest * (1 + bump[:, None]), rest)
    plane = symsurf.Plane((1, 0, 0), 0)
    for pairing in ("closest", "homologous"):
        made = symsurf.symmetrize(
            symsurf.Shape(sculpted, faces), plane, side="positive", pairing=pairing
        )
        points = made.shape.points
        np.testing.assert_allclose(points[partner] * (-1, 1, 1), points, atol=1e-6)
        np.testing.assert_allclose(points[rest[:, 0] > 0], sculpted[rest[:, 0] > 0])


def test_landmark_pairs_are_indices_or_places():
    body = pyvista.Icosphere(nsub=3).rotate_vector((1, 2, 3), 40)  # no vertex has a twin
    points = np.asarray(body.points, dtype=float) * (1, 0.8, 1.2)
    twisted = points + 0.05 * np.clip(points[:, :1], 0, None) * np.cross(points, (1, 0, 0))
    shape = symsurf.Shape(twisted, body.regular_faces)
    plane = symsurf.Plane((1, 0, 0), 0)
    pairs = np.array([[3, 50], [120, 7]])

    def vectors(**options):
        return symsurf.asymmetry(shape, plane, pairing="homologous", **options).vector

    by_index = vectors(pairs=pairs, pairs_sd=0.01)
    np.testing.assert_array_equal(by_index, vectors(pairs=twisted[pairs], pairs_sd=[0.01, 0.01]))
    assert np.abs(by_index - vectors()).max() > 1e-3
    for bad, says in [
        ({"pairs": [[0, len(points)]]}, "pairs name the points 0 to"),
        ({"pairs": [[0.5, 1]]}, r"pairs have shape \(1, 2\) and type float64"),
        ({"pairs": pairs, "pairs_sd": [1, 2, 3]}, "one for each of the 2 pairs"),
        ({"pairs": pairs, "pairs_sd": -1}, "0 or more"),
    ]:
        with pytest.raises(symsurf.InvalidInput, match=says):
            vectors(**bad)
    for operation in (symsurf.asymmetry, symsurf.align):
        with pytest.raises(symsurf.InvalidInput, match="they need the pairing homologous"):
            operation(shape, plane, pairs=pairs)


def test_the_command_line_reads_landmark_pairs(tmp_path):
    body = pyvista.Icosphere(nsub=3).rotate_vector((1, 2, 3), 40)  # no vertex has a twin
    points = np.asarray(body.points, dtype=float) * (1, 0.8, 1.2)
    shape = symsurf.Shape(points, body.regular_faces)
    pairs = np.array([[3, 50], [120, 7]])
    body.points = points
    body.save(tmp_path / "body.vtp")
    np.savetxt(tmp_path / "indices.csv", pairs, delimiter=",", fmt="%d")
    np.savetxt(tmp_path / "places.csv", points[pairs].reshape(-1, 6), delimiter=",", fmt="%.17g")
    np.savetxt(tmp_path / "wrong.csv", [[1, 2, 3]], delimiter=",", fmt="%d")
    line = "asymmetry body.vtp --mirror x=0 --pairing homologous --pairs-sd 0.01 --pairs"
    expected = symsurf.asymmetry(
        shape, "x=0", pairing="homologous", pairs=pairs, pairs_sd=0.01, threads=1
    ).vector
    for name in ("indices", "places"):
        done = run_here(f"{line} {name}.csv -o {name}.vtp", tmp_path)
        assert done.returncode == 0, done.stderr
        found = pyvista.read(tmp_path / f"{name}.vtp")["vector"]
        np.testing.assert_allclose(found, expected, atol=1e-9)
    wrong = run_here(f"{line} wrong.csv", tmp_path)
    assert wrong.returncode == 2
    assert "wrong.csv: rows have 3 numbers" in wrong.stderr


def test_completed_shapes_have_three_corners_a_face():
    points, faces = icosphere()
    faces = np.vstack([faces, [(3, 3, 5), (7, 9, 9)]])
    half = symsurf.cut(symsurf.Shape(points, faces), symsurf.Plane((1, 0, 0), 0.01), capped=False)
    spoilt = symsurf.Shape(half.shape.points, np.vstack([[(2, 2, 4)], half.shape.faces]))
    whole = symsurf.complete(spoilt, symsurf.Plane((1, 0, 0), 0.01))
    made = whole.shape.faces
    assert (np.diff(np.sort(made, axis=1), axis=1) > 0).all()
    assert len(made) == 2 * len(half.shape.faces) == len(whole.face_sources)
    assert whole.shape.to_pyvista().is_manifold
    assert len(whole.patch.faces) == len(half.shape.faces)
    assert (spoilt.faces[whole.face_sources[: len(half.shape.faces)]] == half.shape.faces).all()
