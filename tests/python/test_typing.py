"""The README's examples of the library pass mypy --strict with the package as it is installed."""

from __future__ import annotations

import subprocess
import sys

import pytest
from conftest import ROOT
from test_readme import examples

CODE = "import symsurf\n\n" + "\n".join(examples("python"))

KINDS = """
import numpy as np
import symsurf
from typing_extensions import assert_type

points = np.zeros((9, 3))
normal = symsurf.detect_plane(points, pair_distance=0.1).mirror.normal
radius = symsurf.detect_sphere(points, absolute=True).mirror.radius
direction = symsurf.detect_fixed_direction("scan.ply").mirror.direction
assert_type(symsurf.detect_plane(points), symsurf.Result[symsurf.Plane])
assert_type(symsurf.detect(points), symsurf.Result[symsurf.Mirror])
assert_type(symsurf.Result.load("found.json"), symsurf.Result[symsurf.Mirror])
assert_type(symsurf.asymmetry(points, max_angle=30.0), symsurf.Asymmetry)
assert_type(symsurf.align("scan.ply", frame="ras").shape, symsurf.Shape)
assert_type(symsurf.symmetries(points, minimum_score=0.5), symsurf.Symmetries)
assert_type(symsurf.intrinsic_symmetry("scan.ply"), symsurf.IntrinsicSymmetry)
assert_type(symsurf.detect(points, parts="connected"), list[symsurf.Result[symsurf.Mirror]])
assert_type(symsurf.symmetries(points, parts="bone"), list[symsurf.Symmetries])
assert_type(symsurf.helical_symmetry("spring.stl"), symsurf.HelicalSymmetry)
assert_type(symsurf.match_pair("left.ply", "right.ply"), symsurf.PairMatch)
plane = symsurf.Plane((1, 0, 0), 0)
assert_type(plane == symsurf.Plane((0, 1, 0), 0), bool)
assert_type(plane.reflect(symsurf.Shape(points)), symsurf.Shape)
plane.reflect(points).astype(float)


def scored(result: symsurf.Result) -> float:
    return result.score


scored(symsurf.detect_sphere(points))
"""

WRONG = {
    "symsurf.detect_plane(points).mirror.centre": "centre",
    "symsurf.detect(points).mirror.normal": "normal",
    "symsurf.detect_plane(points, pair_distance='2 mm')": "detect_plane",
    "symsurf.asymmetry(points).index": "index",
    "symsurf.asymmetry(points, speed=3)": "speed",
    "symsurf.symmetries(points, minimum_scores=3)": "minimum_scores",
    "plane.reflect(symsurf.Shape(points)).scales": "scales",
}


def checked(code, folder):
    """What mypy says."""
    pytest.importorskip("mypy", reason="needs mypy, which .ci/setup lint installs")
    (folder / "example.py").write_text(code)
    # PyVista's own types are large, and not ours.
    (folder / "mypy.ini").write_text("[mypy]\n[mypy-pyvista.*]\nfollow_imports = skip\n")
    command = [sys.executable, "-m", "mypy", "--strict", "example.py"]
    cache = ["--cache-dir", str(ROOT / "build" / "mypy-examples")]
    done = subprocess.run(
        [*command, *cache], cwd=folder, capture_output=True, text=True, check=False
    )
    return done.stdout + done.stderr


@pytest.mark.parametrize("code", [CODE, KINDS], ids=["readme", "kinds"])
def test_examples_are_well_typed(code, tmp_path):
    assert "Success" in checked(code, tmp_path)


def test_what_is_wrong_is_found(tmp_path):
    start = KINDS.split("normal =")[0] + "plane = symsurf.Plane((1, 0, 0), 0)\n"
    said = checked(start + "\n".join(WRONG) + "\n", tmp_path)
    first = start.count("\n") + 1
    for line, about in enumerate(WRONG.values(), first):
        assert any(
            # Of overloads the notes name the arguments.
            message.startswith((f"example.py:{line}: error", f"example.py:{line}: note"))
            and about in message
            for message in said.splitlines()
        ), said
