"""A method, an operation or a parameter that only one of the front ends has fails here."""

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
# MeshLab's layers bring their faces, are no grids or files of other programs, and log what is left out.
# Its own filters split a layer into parts, and draw samples of it.
OF_PYTHON = {"absolute", "shape", "method", "normals", "progress", "parameters"} | {
    "faces",
    "threshold",
    "scalars",
    "nonfinite",
    "label",
    "external_files",
    "parts",
    "repeat",
    "weights",
}


def shown_values(method: str) -> dict:
    return cloud().mesh_set().filter_parameter_values(PREFIX + method)


def filter_of(operation: str) -> str:
    described = symsurf.operations()[operation]
    changes = described.moves_points or described.adds_points or described.carries_values
    return ("apply_" if changes else "compute_") + described.title.lower().replace(" ", "_")


def test_there_is_one_filter_a_method_and_one_an_operation():
    filters = {name for name in pymeshlab.filter_list() if "_mirror_" in name}
    methods = {PREFIX + name for name in symsurf.methods()}
    operations = {filter_of(name) for name in symsurf.operations()}
    assert filters == methods | operations | {"apply_mirror_reflection", "create_mirror_sample"}
    assert "apply_mirror_alignment" in operations and "compute_mirror_asymmetry" in operations


def test_there_is_one_filter_an_analysis():
    assert {f"compute_{name}" for name in symsurf.analyses()} <= set(pymeshlab.filter_list())


@pytest.mark.parametrize("analysis", symsurf.analyses())
def test_parameters_of_analyses_are_those_described(analysis):
    described = symsurf.analyses()[analysis].parameters
    shown = cloud().mesh_set().filter_parameter_values(f"compute_{analysis}")
    of_the_host = {"only_selected", "use_faces", "threads"}
    of_the_host |= {"other_layer"} if symsurf.analyses()[analysis].takes_other else set()
    assert set(shown) == {p.name for p in described} | of_the_host
    assert_defaults(shown, described)


@pytest.mark.parametrize("method", symsurf.methods())
def test_parameters_are_those_described(method):
    described = [p.name for p in symsurf.methods()[method].parameters]
    common = set(inspect.signature(symsurf.detect).parameters) - OF_PYTHON
    assert set(shown_values(method)) == set(described) | common | OF_THE_HOST
    assert len(described) + len(common) + len(OF_THE_HOST) == len(shown_values(method))


@pytest.mark.parametrize("method", symsurf.methods())
def test_defaults_are_those_described(method):
    assert_defaults(shown_values(method), symsurf.methods()[method].parameters)


@pytest.mark.parametrize("operation", symsurf.operations())
def test_parameters_of_operations_are_those_described(operation):
    described = symsurf.operations()[operation]
    shown = cloud().mesh_set().filter_parameter_values(filter_of(operation))
    of_the_host = {"mirror_layer", "find_mirror", "require_found", "threads"}
    if described.takes_mask:
        of_the_host |= {"only_selected", "weigh_by_quality"}
    of_the_host |= {"other_layer"} if described.takes_other else set()
    names = [p.name for p in described.parameters]
    of_the_host |= {"landmarks_layer", "landmarks_deviation"} if "pairing" in names else set()
    assert set(shown) == set(names) | of_the_host and len(shown) == len(names) + len(of_the_host)
    assert_defaults(shown, described.parameters)


def assert_defaults(shown: dict, described: list[symsurf.Parameter]) -> None:
    for p in described:
        value = shown[p.name]
        if p.type == "real" and p.unit == "diagonal":
            assert value == pytest.approx(p.default * cloud().diagonal, rel=1e-6)
        elif p.type in ("real", "direction", "position"):
            assert np.allclose(value, p.default, rtol=1e-6, atol=0)
        elif p.type == "choice":
            assert value in (p.default, p.choices.index(p.default))
        else:
            assert value == p.default and type(value) is type(p.default)
