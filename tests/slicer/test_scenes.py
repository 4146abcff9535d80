"""What the logic of the module makes of scenes, in slicer-core."""

from __future__ import annotations

import re

import numpy as np
import pytest
from conftest import ROOT

ACROSS = 5.0  # where the mirror of the head lies, R = 5 mm; see hosts/scenes.py


@pytest.mark.parametrize("turned", ["", "turned"])
def test_the_plane_and_the_transform_lie_where_the_mirror_is(in_slicer, turned):
    made = in_slicer("of_a_model", turned)
    to_world, matrix = np.array(made["to_world"]), np.array(made["matrix"])
    assert made["verdict"] == "found" and made["mirror_cells"] > 100
    normal = to_world[:3, 0]
    np.testing.assert_allclose(made["plane"]["normal"], normal, atol=1e-6)
    on = (to_world @ (ACROSS, 0, 0, 1))[:3]
    assert abs(normal @ (np.array(made["plane"]["centre"]) - on)) < 1e-4
    # Over the head, 60 mm long and some 50 high.
    assert 50 < min(made["plane"]["size"]) < max(made["plane"]["size"]) < 75
    assert np.linalg.det(matrix) == pytest.approx(1)
    # The mirror comes to R = 0, the right stays on the right.
    for across, expected in ((ACROSS, 0), (ACROSS + 10, 10)):
        for a, s in ((0, 0), (30, 60)):
            assert (matrix @ to_world @ (across, a, s, 1))[0] == pytest.approx(expected, abs=1e-4)


def test_a_segment_has_its_mirror(in_slicer):
    made = in_slicer("of_a_segmentation")
    assert abs(made["plane"]["normal"][0]) > 0.9999
    assert made["plane"]["centre"][0] == pytest.approx(3, abs=0.1)  # voxels of 1 mm
    assert made["none"] == "the segment is ''; Segmentation has bone, other"
    assert made["unknown"] == "the segment is 'skin'; Segmentation has bone, other"


def test_points_that_are_not_finite_are_left_out(in_slicer):
    made = in_slicer("with_holes")
    assert made["plane"]["normal"][0] == pytest.approx(1)
    assert made["plane"]["centre"][0] == pytest.approx(ACROSS, abs=1e-3)
    assert made["points"] == -3 and made["given"] == 0
    assert made["cells"] == -16  # six around each point, two of them shared by neighbours


def test_the_model_is_coloured_by_its_asymmetry(in_slicer):
    made = in_slicer("coloured")
    assert {"signed", "distance", "vector", "lateral", "matched"} <= set(made["names"])
    assert made["given"] == 0  # the model that was given has no more arrays than before
    assert -3 < made["least_right"] < -1.5  # too far out by the bump of 3 mm
    assert 1.2 < made["greatest_left"] < 3
    low, high = made["range"]
    assert 0.1 < high < 3 and low == -high
    assert made["shown"] == [1, "signed"] and made["same_colours"]
    blue, even, red = made["ends"]
    assert blue[2] > blue[0] and min(even) > 0.9 and red[0] > red[2]


def test_landmarks_are_paired(in_slicer):
    made = in_slicer("landmarks")
    table = made["table"]
    assert table["Landmark"] == ["eye_l", "nose", "ear_l"]
    assert table["Partner"] == ["eye_r", "nose", ""]
    assert table["Distance"][:2] == pytest.approx([2, 0], abs=1e-4) and table["Distance"][2] is None
    np.testing.assert_allclose(made["points"]["eye_l"], (ACROSS - 10, -82, 40), atol=1e-4)
    np.testing.assert_allclose(made["points"]["eye_r"], (ACROSS + 10, -80, 40), atol=1e-4)
    np.testing.assert_allclose(made["points"]["nose"], (ACROSS, -70, 40), atol=1e-4)
    assert made["descriptions"] == ["image of eye_r", "image of eye_l", "image of nose"]
    assert "no landmarks are chosen" in made["none"]


def test_the_table_has_a_row_for_each_shape(in_slicer):
    table = in_slicer("table")
    assert table["Shape"] == ["Swollen", "Even"] and table["verdict"] == ["found", "found"]
    assert len({len(column) for column in table.values()}) == 1
    assert table["maximum"][0] > 1 and table["maximum"][1] < 1e-6
    assert table["score"][0] < table["score"][1]


def test_all_symmetries_of_a_part_are_in_a_table(in_slicer):
    made = in_slicer("symmetries")
    elements, to_world = made["elements"], np.array(made["to_world"])
    assert elements["Element"] == ["plane"] * 3 + ["axis"] * 3
    assert elements["Order"] == [""] * 3 + ["2"] * 3
    assert made["figures"]["group"] == ["D2h"]
    directions = np.column_stack([elements[f"Direction {name}"] for name in "RAS"])
    for three in (directions[:3], directions[3:]):  # those of the box, in some order
        np.testing.assert_allclose(abs(three @ to_world[:3, :3]).max(axis=1), 1, atol=1e-9)
    points = np.column_stack([elements[f"Point {name}"] for name in "RAS"])
    np.testing.assert_allclose(points, np.tile(to_world[:3, 3], (6, 1)), atol=1e-6)


def test_what_is_wrong_is_said(in_slicer):
    said = in_slicer("refused")
    assert said[0] == "no shape is chosen; allowed is a model or a segmentation"
    assert said[1] == "Empty has no surface"
    assert said[2] == "Points is a vtkMRMLMarkupsFiducialNode; allowed is a model or a segmentation"
    assert "'mirror'; there are auto, plane" in said[3]
    assert said[4].startswith("tolerance is 7; allowed is")
    assert said[5].startswith("perpendicular finds no mirror in Plate")


def test_the_search_can_be_cancelled(in_slicer):
    assert in_slicer("cancelled") == {"calls": 1, "points": 0}


def test_a_mirror_that_bends(in_slicer):
    made = in_slicer("curved")
    assert made["kind"] == "cylinder"
    assert made["radii"] == pytest.approx([50, 50], abs=0.1)
    normal, centre = made["plane"]["normal"], made["plane"]["centre"]
    assert abs(normal[0]) > 0.99 and abs(centre[0]) < 1  # it touches the cylinder at R = 0


def test_the_example_of_the_page_runs(in_slicer, tmp_path):
    page = (ROOT / "docs" / "slicer.md").read_text()
    (script,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    path = tmp_path / "example.py"
    path.write_text(script)
    made = in_slicer("example", str(path))
    assert made == {"MarkupsPlane": 2, "LinearTransform": 2, "Model": 4, "Table": 1}
