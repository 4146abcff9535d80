"""Symmetries that colours break: a label on a bottle."""

from __future__ import annotations

import json

import numpy as np
import pytest
from accuracy.coloured_parts import COLOURED_PARTS, ColouredPart
from accuracy.solids import sampled
from command_line import run
from numpy.typing import NDArray
from symmetric_shapes import random_rotation

import symsurf

Array = NDArray[np.float64]
BOTTLE = COLOURED_PARTS["bottle with a label"]


def posed_mesh(part: ColouredPart, seed: int = 0) -> tuple[Array, Array, Array, Array]:
    """Points, faces, colours, and the pose's rotation."""
    points, faces, colours = part.mesh(edge=0.08)
    rotation = random_rotation(np.random.default_rng(seed))
    return 3 * points @ rotation.T + (5, -2, 1), faces, colours, rotation


def cloud(part: ColouredPart, count: int = 15_000, seed: int = 0) -> tuple[Array, Array]:
    corners = part.triangles.reshape(-1, 3)
    faces = np.arange(len(corners)).reshape(-1, 3)
    points = sampled(corners, faces, count, np.random.default_rng(seed))
    return points, part.painted(points)


@pytest.mark.parametrize("name", COLOURED_PARTS)
def test_coloured_meshes_have_the_group_of_shape_and_colours(name):
    part = COLOURED_PARTS[name]
    points, faces, colours, _ = posed_mesh(part)
    found = symsurf.symmetries(points, faces=faces, colours=colours, texture=True)
    assert found.group == part.group


def test_the_mirror_of_a_bottle_goes_through_its_label():
    points, faces, colours, rotation = posed_mesh(BOTTLE)
    found = symsurf.symmetries(points, faces=faces, colours=colours, texture=True)
    (plane,) = found.planes
    assert np.degrees(np.arcsin(abs(plane.normal @ rotation[:, 1]))) > 89
    assert found.to_bop() == {}
    assert found.parameters["texture"]
    without = symsurf.symmetries(points, faces=faces)
    assert without.group == "C∞v" and not without.parameters["texture"]


@pytest.mark.parametrize("name", ["bottle with a label", "gear with three painted sectors"])
def test_units_of_colours_and_threads_do_not_count(name):
    points, colours = cloud(COLOURED_PARTS[name])
    once = symsurf.symmetries(points, colours=colours, texture=True, threads=1)
    assert once.group == COLOURED_PARTS[name].group
    again = symsurf.symmetries(points, colours=colours, texture=True, threads=2)
    assert np.array_equal(again.elements, once.elements)
    scaled = symsurf.symmetries(points, colours=np.round(255 * colours), texture=True)
    assert scaled.group == once.group
    with_alpha = np.column_stack([colours, np.ones(len(colours))])
    assert symsurf.symmetries(points, colours=with_alpha, texture=True).group == once.group


def test_one_colour_breaks_nothing():
    points, _ = cloud(COLOURED_PARTS["plain gear"])
    plain = symsurf.symmetries(points)
    grey = symsurf.symmetries(points, colours=np.full((len(points), 3), 0.5), texture=True)
    assert grey.group == plain.group == "D12h"
    np.testing.assert_allclose(grey.elements, plain.elements, atol=1e-12)


def test_what_is_cut_away_has_no_colour():
    """The images that fall into a hole say nothing."""
    part = COLOURED_PARTS["box of two halves"]
    points, colours = cloud(part)
    left = np.linalg.norm(points - (1, 0.7, 0.45), axis=1) > 0.5
    found = symsurf.symmetries(points[left], colours=colours[left], texture=True)
    assert found.group == part.group == "C2v"


def test_atoms_of_one_kind_fall_on_such():
    """Methane, then with a hydrogen replaced, then with two."""
    hydrogens = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) * 0.63
    atoms = np.concatenate([np.zeros((1, 3)), hydrogens])
    for numbers, group in (
        ([6, 1, 1, 1, 1], "Td"),
        ([6, 17, 1, 1, 1], "C3v"),
        ([6, 17, 17, 1, 1], "C2v"),
        ([6, 17, 9, 1, 1], "Cs"),
        ([6, 17, 9, 35, 1], "C1"),
    ):
        assert symsurf.symmetries(atoms, colours=numbers, texture=True).group == group


def test_points_that_are_not_finite_need_no_colour():
    points, colours = cloud(COLOURED_PARTS["box with a label"])
    points, colours = np.insert(points, 7, np.nan, axis=0), np.insert(colours, 7, np.nan, axis=0)
    with pytest.warns(symsurf.InputWarning, match="1 point is not finite"):
        found = symsurf.symmetries(points, colours=colours, texture=True)
    assert found.group == "C2v"


def test_bad_colours_are_named():
    points, colours = cloud(BOTTLE, 500)
    for given, message in (
        (colours[:499], "499 colours are given for 500 points; allowed is one per point"),
        (colours[None], r"colours have shape \(1, 500, 3\); allowed is \(n, k\)"),
        (np.where(np.arange(500)[:, None] == 3, np.nan, colours), "the colour of point 3 is not"),
        (["red"] * 500, "colours are no numbers"),
    ):
        with pytest.raises(symsurf.InvalidInput, match=message):
            symsurf.symmetries(points, colours=given, texture=True)
    with pytest.raises(symsurf.InvalidInput, match="texture is true, but no colours are given"):
        symsurf.symmetries(points, texture=True)
    with pytest.raises(symsurf.InvalidParameter, match="colours are given, but texture is not"):
        symsurf.symmetries(points, colours=colours)
    with pytest.raises(TypeError, match="colours"):
        symsurf.partial_symmetries(points, colours=colours)


PLY = "ply\nformat ascii 1.0\nelement vertex {}\n{}end_header\n{}\n"
PROPERTIES = "".join(
    f"property {kind} {name}\n"
    for kind, names in (("double", "x y z"), ("uchar", "red green blue"))
    for name in names.split()
)


def files_of(points: Array, colours: Array) -> dict[str, str]:
    rows = [
        " ".join([*map(repr, point), *map(str, colour)])
        for point, colour in zip(points.tolist(), colours.tolist())
    ]
    return {
        "a.ply": PLY.format(len(points), PROPERTIES, "\n".join(rows)),
        "a.obj": "\n".join(f"v {row}" for row in rows) + "\n",
        "a.off": f"COFF\n{len(points)} 0 0\n" + "\n".join(f"{row} 255" for row in rows) + "\n",
        "a.xyz": "\n".join(rows) + "\n",
    }


def test_colours_are_read_from_files(tmp_path):
    points, colours = cloud(BOTTLE, 8000)
    colours = np.round(255 * colours).astype(int)
    for name, content in files_of(points, colours).items():
        path = tmp_path / name
        path.write_text(content)
        assert np.array_equal(symsurf.read(path).colours, colours), name
    found = symsurf.symmetries(tmp_path / "a.ply", texture=True)
    assert found.group == "Cs"
    assert np.array_equal(found.shape.colours, colours)
    record = json.loads(run("symmetries", tmp_path / "a.obj", "--texture", "--json").stdout)
    assert record["group"] == "Cs"
    np.savetxt(tmp_path / "plain.xyz", points)
    refused = run("symmetries", tmp_path / "plain.xyz", "--texture")
    assert refused.returncode == 1 and "texture is true, but no colours" in refused.stderr


def test_the_meshes_of_others_bring_their_colours():
    pyvista = pytest.importorskip("pyvista")
    points, faces, colours, _ = posed_mesh(COLOURED_PARTS["cube with a painted side"])
    mesh = pyvista.PolyData.from_regular_faces(points, faces)
    mesh.point_data["RGB"] = np.round(255 * colours).astype(np.uint8)
    mesh.set_active_scalars("RGB")
    assert symsurf.symmetries(mesh, texture=True).group == "C4v"
    assert mesh.symmetry.symmetries(texture=True).field_data["group"][0] == "C4v"
    assert np.array_equal(symsurf.Shape.from_pyvista(mesh).colours, mesh["RGB"])


def test_the_filter_compares_the_array_that_is_named():
    pyvista = pytest.importorskip("pyvista")
    from symsurf.vtk import SymmetryAnalysis

    points, faces, colours, _ = posed_mesh(COLOURED_PARTS["box with a label"])
    mesh = pyvista.PolyData.from_regular_faces(points, faces)
    mesh.point_data["Paint"] = colours
    mesh.point_data["Height"] = np.zeros(len(points))
    mesh.set_active_scalars("Height")

    def group(**properties: object) -> str:
        made = SymmetryAnalysis(input_data=mesh, symmetries_texture=True, **properties)
        made.Update()
        return made.output.GetFieldData().GetAbstractArray("Group").GetValue(0)

    assert group(colour_array="Paint") == "C2v"
    assert group() == group(colour_array="None") == "D2h"
    failed = []
    made = SymmetryAnalysis(input_data=mesh, symmetries_texture=True, colour_array="Ink")
    made.AddObserver("ErrorEvent", lambda *_: failed.append(True))
    made.Update()
    assert failed and made.output.GetNumberOfPoints() == 0
