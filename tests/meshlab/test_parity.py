"""A method or a parameter that only one of the front ends has fails here."""

from __future__ import annotations

import inspect

import numpy as np
import pymeshlab
import pytest
from shapes import cloud

symsurf = pytest.importorskip("symsurf", reason="the Python module is not installed")

PREFIX = "compute_mirror_"
# What only a host with selections, stored normals and layers has to ask.
OF_THE_HOST = {"only_selected", "use_normals", "show_candidates"}
# What a dialog has no use for: the layer is the input, the filter the method, the bar the progress.
# MeshLab's layers bring their faces, are no grids, and log what is left out.
OF_PYTHON = {"points", "method", "normals", "progress", "parameters"} | {
    "faces",
    "threshold",
    "scalars",
    "nonfinite",
}


def shown_values(method: str) -> dict:
    return cloud().mesh_set().filter_parameter_values(PREFIX + method)


def test_there_is_one_filter_a_method():
    filters = {name for name in pymeshlab.filter_list() if name.startswith(PREFIX)}
    assert filters == {PREFIX + name for name in symsurf.methods()}


def test_the_other_filters_are_there():
    assert {"apply_mirror_reflection", "create_mirror_sample"} <= set(pymeshlab.filter_list())


@pytest.mark.parametrize("method", symsurf.methods())
def test_parameters_are_those_described(method):
    described = [p.name for p in symsurf.methods()[method].parameters]
    common = set(inspect.signature(symsurf.detect).parameters) - OF_PYTHON
    assert set(shown_values(method)) == set(described) | common | OF_THE_HOST
    assert len(described) + len(common) + len(OF_THE_HOST) == len(shown_values(method))


@pytest.mark.parametrize("method", symsurf.methods())
def test_defaults_are_those_described(method):
    shown = shown_values(method)
    for p in symsurf.methods()[method].parameters:
        value = shown[p.name]
        if p.type == "real" and p.unit == "diagonal":
            assert value == pytest.approx(p.default * cloud().diagonal, rel=1e-6)
        elif p.type in ("real", "direction", "position"):
            assert np.allclose(value, p.default, rtol=1e-6, atol=0)
        elif p.type == "choice":
            assert value in (p.default, p.choices.index(p.default))
        else:
            assert value == p.default and type(value) is type(p.default)
