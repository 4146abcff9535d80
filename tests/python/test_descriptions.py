"""The methods' one description against what Python, the command line and the stubs make of it."""

from __future__ import annotations

import ast
import inspect
import json
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import symsurf
from symsurf import cli

METHODS = symsurf.methods()
OPTIONS = [
    "parts",
    "faces",
    "use_faces",
    "normals",
    "weights",
    "nonfinite",
    "threshold",
    "label",
    "scalars",
    "external_files",
    "absolute",
    "repeat",
    "seed",
    "threads",
    "progress",
]


def plain(value):
    return tuple(value.tolist()) if isinstance(value, np.ndarray) else value


@pytest.mark.parametrize("name", METHODS)
def test_signatures(name):
    method, function = METHODS[name], getattr(symsurf, f"detect_{name}")
    shape, *keywords = inspect.signature(function).parameters.values()
    assert shape.name == "shape"
    assert all(keyword.kind is keyword.KEYWORD_ONLY for keyword in keywords)
    described = {parameter.name: plain(parameter.default) for parameter in method.parameters}
    shown = {keyword.name: keyword.default for keyword in keywords}
    assert [word for word in shown if word not in described] == OPTIONS
    assert {word: shown[word] for word in described} == described
    assert function.__name__ in symsurf.__all__
    assert " ".join(method.summary.split()) in " ".join(function.__doc__.split())
    for parameter in method.parameters:
        sentence = f"{parameter.name}: {parameter.doc} Allowed: {parameter.allowed}."
        assert sentence in " ".join(function.__doc__.split())


@pytest.mark.parametrize("name", METHODS)
def test_defaults_are_what_is_used(name, blob):
    blob = blob[:100]  # sphere_thesis tries every pair
    method = METHODS[name]
    expected = {parameter.name: parameter.default for parameter in method.parameters}
    by_function = getattr(symsurf, f"detect_{name}")(blob).parameters
    spelled_out = symsurf.detect(blob, name, **expected).parameters
    if name == "auto":
        assert by_function == spelled_out  # those of the method it chose
        return
    for used in (by_function, spelled_out):
        assert used.keys() == expected.keys()
        for parameter, value in expected.items():
            np.testing.assert_array_equal(used[parameter], value)


@pytest.mark.parametrize("name", METHODS)
def test_descriptions_are_whole(name):
    method = METHODS[name]
    assert method.name == name and method.title and method.summary.endswith(".")
    for parameter in method.parameters:
        assert parameter.doc.endswith(".")
        assert parameter.unit in ("", "diagonal", "points", "degrees")
        if parameter.type in ("integer", "real"):
            assert parameter.minimum <= parameter.default <= parameter.maximum
        if parameter.type == "choice":
            assert parameter.default in parameter.choices


def test_command_line_options():
    options = cli.parser_of("detect")._option_string_actions
    for method in METHODS.values():
        for parameter in method.parameters:
            assert f"--{parameter.name}" in options
            option = options[f"--{parameter.name.replace('_', '-')}"]
            assert parameter.doc in option.help.replace("%%", "%")
            assert parameter.allowed in option.help.replace("%%", "%")


def test_command_line_lists_the_methods(capsys):
    assert cli.main(["methods", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert list(listed) == list(METHODS)
    for name, method in METHODS.items():
        assert listed[name]["summary"] == method.summary
        assert [p["name"] for p in listed[name]["parameters"]] == [
            p.name for p in method.parameters
        ]
        for shown, parameter in zip(listed[name]["parameters"], method.parameters):
            assert shown["range"] == parameter.range
            np.testing.assert_array_equal(shown["default"], parameter.default)
    assert cli.main(["methods"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    for method in METHODS.values():
        assert method.summary in text
        assert all(parameter.doc in text for parameter in method.parameters)


def installed(name: str) -> str:
    return Path(str(resources.files("symsurf") / name)).read_text()


def test_stubs_are_shipped():
    assert installed("py.typed") == ""
    compiled = {
        node.name
        for node in ast.parse(installed("_core.pyi")).body
        if isinstance(node, (ast.ClassDef, ast.FunctionDef))
    }
    public = {name for name in vars(symsurf._core) if not name.startswith("_")}
    assert public <= compiled


def test_stubs_of_the_methods():
    stubs = {
        node.name: node
        for node in ast.parse(installed("detection/detectors.pyi")).body
        if isinstance(node, ast.FunctionDef)
    }
    assert set(stubs) == {f"detect_{name}" for name in METHODS}
    for name, method in METHODS.items():
        arguments = stubs[f"detect_{name}"].args
        assert [argument.arg for argument in arguments.kwonlyargs] == [
            *(parameter.name for parameter in method.parameters),
            *OPTIONS,
        ]
        for parameter, node in zip(method.parameters, arguments.kw_defaults):
            assert ast.literal_eval(node) == plain(parameter.default)
