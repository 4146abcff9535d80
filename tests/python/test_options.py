"""Reading and searching have the same options in all functions, commands and filters."""

from __future__ import annotations

import dataclasses
import inspect
import json
import time

import numpy as np
import pytest
from command_line import run_here
from symmetric_shapes import mirrored_surface

import symsurf
from symsurf.base.options import Reading, Search, documentation
from symsurf.mirror_operations.operate import FOUND_AT

READING = {each.name: each.default for each in dataclasses.fields(Reading)}
SEARCH = {each.name: each.default for each in dataclasses.fields(Search)}
DETECTORS = [f"detect_{name}" for name in symsurf.methods()]


@pytest.mark.parametrize(
    ("names", "options"),
    [
        (["read"], READING),
        (["detect", "batch", *symsurf.operations()], READING | SEARCH),
        (DETECTORS, READING | {name: SEARCH[name] for name in ("seed", "nonfinite")}),
        (["match", *symsurf.analyses()], READING | {"nonfinite": "skip"}),
        (["detect_chunks"], SEARCH | {"external_files": False}),
        (["summarize", "match_chunks", "save_matches"], {"external_files": False}),
    ],
)
def test_functions(names, options):
    for name in names:
        function = getattr(symsurf, name)
        shown = inspect.signature(function).parameters
        assert {each: shown[each].default for each in options if each in shown} == options, name
        said = " ".join(function.__doc__.split())
        assert all(f"{each}:" in said or f"{each}," in said for each in options), name
        assert "{" not in said


COMMANDS = {
    "detect": READING | SEARCH,
    "report": READING | SEARCH,
    **dict.fromkeys(symsurf.operations(), READING | SEARCH),
    **dict.fromkeys(symsurf.analyses(), READING | {"nonfinite": "skip"}),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_commands(command, tmp_path):
    said = " ".join(run_here(f"{command} --help", tmp_path).stdout.split())
    texts = documentation(Reading) | documentation(Search)
    for name in COMMANDS[command]:
        assert f"--{name.replace('_', '-')}" in said
        assert " ".join(texts[name].split()) in said.replace("- ", "-")


# A map of labels: label 1 is a body, label 2 another, each mirrored in its own axis.
VOXELS = np.zeros((24, 24, 24), np.uint8)
VOXELS[3:21, 4:9, 6:9] = 1
VOXELS[10:14, 9:12, 6:9] = 1  # in i alone, about 11.5
VOXELS[2:5, 13:23, 13:18] = 2
VOXELS[5:9, 17:19, 13:15] = 2  # in j alone, about 17.5


@pytest.fixture
def labels(tmp_path):
    nrrd = pytest.importorskip("nrrd")
    nrrd.write(str(tmp_path / "labels.nrrd"), VOXELS)
    return tmp_path / "labels.nrrd"


@pytest.mark.parametrize(("label", "axis", "middle"), [(1, 0, 11.5), (2, 1, 17.5)])
def test_a_label_in_every_function(label, axis, middle, labels):
    truth = symsurf.Plane(np.eye(3)[axis], -middle)
    points = np.argwhere(VOXELS == label)
    found = symsurf.detect(labels, "plane", label=label)
    assert abs(found.mirror.normal[axis]) > 0.9999
    assert len(symsurf.match(labels, truth, label=label).pairs) == len(points)
    made = symsurf.asymmetry(labels, label=label, method="plane")
    assert len(made.distance) == len(points) and made.found.method == "plane"
    assert abs(made.mirror.normal[axis]) > 0.9999
    symmetries = symsurf.symmetries(labels, label=label)
    assert any(abs(plane.normal[axis]) > 0.999 for plane in symmetries.planes)
    (row,) = symsurf.batch([labels], "asymmetry", label=label, method="plane")
    assert row["error"] == "" and row["points"] == len(points)
    line = f"{{}} labels.nrrd --label {label} --json"
    for command in ("detect --method plane", "asymmetry --method plane", "symmetries"):
        done = run_here(line.format(command), labels.parent)
        assert done.returncode == 0 and json.loads(done.stdout)["points"] == len(points)


def test_scalars_in_every_function(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    image = pyvista.ImageData(dimensions=VOXELS.shape)
    image["other"] = np.zeros(VOXELS.size, np.uint8)
    image["labels"] = VOXELS.ravel("F")
    image.set_active_scalars("other")
    image.save(tmp_path / "image.vti")
    options = {"scalars": "labels", "label": 2}
    count = np.count_nonzero(VOXELS == 2)
    for given in (image, tmp_path / "image.vti"):
        assert len(symsurf.detect(given, "plane", **options).points) == count
        made = symsurf.align(given, symsurf.Plane((0, 1, 0), -17.5), **options)
        assert len(made.shape.points) == count
        with pytest.raises(symsurf.InvalidInput):
            symsurf.align(given, symsurf.Plane((0, 1, 0), -17.5))
    line = "align image.vti --scalars labels --label 2 --method plane --json"
    assert json.loads(run_here(line, tmp_path).stdout)["points"] == count
    with pytest.raises(symsurf.InvalidParameter, match="label is 2; allowed is None"):
        symsurf.align(np.argwhere(VOXELS == 2), symsurf.Plane((0, 1, 0), -17.5), label=2)


def test_labels_of_vtk_filters():
    pytest.importorskip("vtkmodules")
    pyvista = pytest.importorskip("pyvista")
    from symsurf.vtk import MirrorAlignment, MirrorDetection

    image = pyvista.ImageData(dimensions=VOXELS.shape)
    image["labels"] = VOXELS.ravel("F")
    for filter_ in (
        MirrorDetection(input_data=image, method="plane", image_label=1),
        MirrorAlignment(input_data=image, method="plane", image_label=1, seed=3),
    ):
        filter_.Update()
        assert filter_.output.GetNumberOfPoints() == np.count_nonzero(VOXELS == 1)


# The search of operations.


@pytest.fixture(scope="module")
def shape():
    return mirrored_surface(800, 0)[0]


@pytest.mark.parametrize("name", ["asymmetry", "align", "symmetrize", "straighten", "complete"])
def test_an_operation_searches_as_it_is_asked(name, shape):
    operate = getattr(symsurf, name)
    found = symsurf.detect(shape, "plane_icp", seed=5)
    made = operate(shape, method="plane_icp", seed=5)
    assert made.mirror == found.mirror and made.found.score == found.score
    assert operate(shape, found).found is None
    with pytest.raises(symsurf.InvalidParameter, match="there is no method 'magic'|magic"):
        operate(shape, method="magic")


def test_a_search_that_is_not_made(shape, tmp_path):
    plane = symsurf.Plane((1, 0, 0), 0)
    for options in ({"method": "plane"}, {"seed": 1}):
        with pytest.raises(symsurf.InvalidParameter, match="no mirror is searched"):
            symsurf.align(shape, plane, **options)
    axis = symsurf.Axis((0, 0, 0), (0, 0, 1), 2)
    with pytest.raises(symsurf.InvalidParameter, match="no mirror is searched"):
        symsurf.complete(shape, axis, method="plane")
    np.savetxt(tmp_path / "a.xyz", shape)
    (tmp_path / "m.json").write_text(
        '{"mirror": {"kind": "plane", "normal": [1, 0, 0], "offset": 0}}'
    )
    done = run_here("align a.xyz --mirror m.json --method plane", tmp_path)
    assert done.returncode == 2 and "no mirror is searched" in done.stderr
    assert run_here("align a.xyz --mirror m.json", tmp_path).returncode == 0


def test_points_that_are_not_finite_are_refused_everywhere(shape, tmp_path):
    points = np.vstack([shape, [[np.nan, 0, 0], [0, np.inf, 0]]])
    plane = symsurf.Plane((1, 0, 0), 0)
    np.savetxt(tmp_path / "a.xyz", points)
    np.save(tmp_path / "a.npy", points)
    refuse = {"nonfinite": "refuse"}
    for call in (
        lambda: symsurf.detect(points, **refuse),
        lambda: symsurf.match(points, plane, **refuse),
        lambda: symsurf.align(points, **refuse),
        lambda: symsurf.align(points, plane, **refuse),
        lambda: symsurf.symmetries(points, **refuse),
        lambda: symsurf.detect_chunks(tmp_path / "a.npy", **refuse),
    ):
        with pytest.raises(symsurf.InvalidInput, match="finite"):
            call()
    for command in ("detect", "align", "symmetries"):
        done = run_here(f"{command} a.xyz --nonfinite refuse", tmp_path)
        assert done.returncode == 1 and "finite" in done.stderr
    (row,) = symsurf.batch([tmp_path / "a.xyz"], "align", nonfinite="refuse")
    assert "finite" in row["error"]
    with pytest.raises(symsurf.InvalidParameter, match="nonfinite is 'drop'"):
        symsurf.align(points, nonfinite="drop")


@pytest.mark.parametrize("name", ["asymmetry", "align", "symmetrize"])
def test_the_search_reports_progress_and_is_cancelled(name):
    points = mirrored_surface(20000, 0)[0]
    told: list[tuple[float, float]] = []
    began = time.process_time()
    getattr(symsurf, name)(
        points,
        method="plane",
        threads=1,
        progress=lambda fraction: told.append((fraction, time.process_time() - began)),
    )
    took = time.process_time() - began
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions) and fractions[0] == 0 and fractions[-1] == 1
    assert sum(fraction < FOUND_AT for fraction in fractions) > 2 and told[0][1] < took / 3
    began = time.process_time()
    with pytest.raises(symsurf.Cancelled):
        getattr(symsurf, name)(points, threads=1, progress=lambda fraction: fraction < 0.01)
    assert time.process_time() - began < took


def test_mesh_symmetry_is_of_the_mesh_as_it_is():
    pyvista = pytest.importorskip("pyvista")
    mesh = pyvista.Sphere(theta_resolution=24, phi_resolution=24)
    mesh.points *= np.float32([1.5, 0.7, 1])
    first = mesh.symmetry.detect(method="plane")
    mesh.symmetry.asymmetry()
    assert mesh.symmetry.result is first
    mesh.points += np.float32(0.3)
    made = mesh.symmetry.asymmetry(method="plane")
    assert mesh.symmetry.result is not first
    assert np.nanmax(np.abs(made["signed"])) < 1e-5
    found = mesh.symmetry.result
    mesh.symmetry.align()  # which goes on with it
    assert mesh.symmetry.result is found
    given = symsurf.Plane((1, 0, 0), -0.3)
    mesh.symmetry.align(result=given)
    assert mesh.symmetry.result is found
