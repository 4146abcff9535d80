"""Filter scripts (.mlx): saved, read again and applied, they repeat what the filters did."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pymeshlab
import pytest
from shapes import lump
from test_operations import filter_of

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

# Every kind of parameter with a value that is not the default: those of the others are the defaults.
CHANGED = {
    "compute_mirror_plane": {
        "pair_distance": pymeshlab.PercentageValue(3),
        "max_candidates": 7,
        "minimum_score": 0.4,
        "show_candidates": True,
    },
    "compute_mirror_fixed_direction": {"direction": [0.3, -1, 2]},
    "apply_mirror_alignment": {"axis": "z", "up": [0, 1, 0.5]},
    "apply_mirror_cut": {"side": "negative", "find_mirror": True},
    "create_mirror_sample": {"generator": "spherical"},
}
FILTERS = [
    *(f"compute_mirror_{name}" for name in symsurf.methods()),
    *map(filter_of, symsurf.operations()),
    "apply_mirror_reflection",
    "create_mirror_sample",
    *(f"compute_{name}" for name in symsurf.analyses()),
]
# The others find a mirror first, where they need one.
NEEDS_MIRROR = {"apply_mirror_reflection": {"mirror_layer": 1}}


def start() -> pymeshlab.MeshSet:
    return lump(around=24, up=12).mesh_set()


def content(mesh_set: pymeshlab.MeshSet) -> list:
    """All that the layers hold that a filter may have put there."""
    return [
        [
            mesh.label(),
            mesh.is_visible(),
            mesh.vertex_matrix(),
            mesh.face_matrix(),
            mesh.edge_matrix(),
            mesh.vertex_color_matrix(),
            mesh.vertex_scalar_array() if mesh.has_vertex_scalar() else [],
            mesh.vertex_selection_array(),
            mesh.face_selection_array(),
        ]
        for mesh in mesh_set
    ]


@pytest.mark.parametrize("name", FILTERS)
def test_a_script_repeats_the_filter(name: str, tmp_path: Path) -> None:
    first = start()
    if name in NEEDS_MIRROR:
        first.apply_filter("compute_mirror_plane")
    first.apply_filter(name, **CHANGED.get(name, {}), **NEEDS_MIRROR.get(name, {}))
    script = str(tmp_path / "script.mlx")
    first.save_filter_script(script)
    second = start()
    second.load_filter_script(script)
    second.apply_filter_script()
    assert len(content(second)) == len(content(first))
    for again, before in zip(content(second), content(first)):
        assert again[:2] == before[:2]
        for one, other in zip(again[2:], before[2:], strict=True):
            np.testing.assert_array_equal(one, other)


def test_a_script_of_several_filters(tmp_path: Path) -> None:
    first = start()
    for name in ("compute_mirror_plane", "apply_mirror_alignment", "compute_mirror_asymmetry"):
        first.apply_filter(name, **CHANGED.get(name, {}))
    script = tmp_path / "script.mlx"
    first.save_filter_script(str(script))
    assert "Mirror alignment" in script.read_text()
    second = start()
    second.load_filter_script(str(script))
    second.apply_filter_script()
    points = second.mesh(0).vertex_matrix()
    np.testing.assert_array_equal(points, first.mesh(0).vertex_matrix())
    # What is aligned lies as symmetric about z = 0.
    assert points[:, 2].max() == pytest.approx(-points[:, 2].min(), rel=1e-6)
