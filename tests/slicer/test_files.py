"""The extension's files: what Slicer's build and its panel read; needs no Slicer."""

from __future__ import annotations

import ast
import importlib.util
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from conftest import MODULE

PANEL = ElementTree.parse(MODULE / "Resources" / "UI" / "MirrorSymmetry.ui").getroot()
SOURCE = (MODULE / "MirrorSymmetry.py").read_text()
TREE = ast.parse(SOURCE)


def class_named(name: str) -> ast.ClassDef:
    return next(n for n in TREE.body if isinstance(n, ast.ClassDef) and n.name == name)


def parameters() -> dict[str, str]:
    """Types by name."""
    body = class_named("MirrorSymmetryParameterNode").body
    return {n.target.id: ast.unparse(n.annotation) for n in body if isinstance(n, ast.AnnAssign)}


def test_the_build_names_every_file():
    text = (MODULE / "CMakeLists.txt").read_text().replace("${MODULE_NAME}", "MirrorSymmetry")
    listed = set(re.findall(r"^  (\S+\.\w+)$", text, re.MULTILINE))
    suffixes = (".py", ".ui", ".svg", ".txt")
    there = {
        path.relative_to(MODULE).as_posix() for path in MODULE.rglob("*") if path.suffix in suffixes
    }
    assert listed == there - {"CMakeLists.txt"}


def test_the_panel_shows_what_the_parameter_node_has():
    selectors = [w for w in PANEL.iter("widget") if w.get("class") == "qMRMLNodeComboBox"]
    shown = {}
    for each in selectors:
        (name,) = each.findall("property[@name='SlicerParameterName']/string")
        shown[name.text] = {kind.text for kind in each.iter("string")} & set(
            re.findall(r"vtkMRML\w+Node", ElementTree.tostring(each, "unicode"))
        )
    nodes = {name: set(re.findall(r"vtkMRML\w+Node", kind)) for name, kind in parameters().items()}
    assert shown == {name: kinds for name, kinds in nodes.items() if kinds}


def test_what_has_a_name_in_the_panel_is_a_parameter():
    names = {
        each.text for each in PANEL.iterfind(".//property[@name='SlicerParameterName']/string")
    }
    assert "useFaces" in names and names <= set(parameters())


def test_every_selector_hears_of_the_scene():
    selectors = {
        w.get("name") for w in PANEL.iter("widget") if w.get("class") == "qMRMLNodeComboBox"
    }
    assert {each.findtext("receiver") for each in PANEL.iter("connection")} == selectors


def test_the_code_uses_widgets_that_are_there():
    names = {w.get("name") for w in PANEL.iter("widget")}
    used = set(re.findall(r"\.ui\.(\w+)", SOURCE))
    assert len(used) >= 6 and used <= names
    assert {w.get("class") for w in PANEL.iter("widget") if w.get("class")[0] != "Q"} == {
        each.text for each in PANEL.iterfind("customwidgets/customwidget/class")
    }


def test_the_outputs_are_those_of_the_logic():
    tree = ast.parse((MODULE / "MirrorSymmetryLib" / "logic.py").read_text())
    outputs = next(n for n in tree.body if isinstance(n, ast.ClassDef) and n.name == "Outputs")
    fields = {n.target.id for n in outputs.body if isinstance(n, ast.AnnAssign)}
    (call,) = [
        n
        for n in ast.walk(class_named("MirrorSymmetryLogic"))
        if isinstance(n, ast.Call) and ast.unparse(n.func) == "Outputs"
    ]
    assert {word.arg for word in call.keywords} == fields
    given = {ast.unparse(word.value).removeprefix("parameterNode.") for word in call.keywords}
    assert given <= set(parameters())


def test_the_entry_of_the_index():
    entry = json.loads((MODULE.parent / "Symsurf.json").read_text())
    assert {"$schema", "category", "scm_url"} <= set(entry) and 1 <= entry["tier"] <= 5
    assert "project(Symsurf)" in (MODULE.parent / "CMakeLists.txt").read_text()


def test_wheels_beside_the_requirements_are_taken_where_they_fit(tmp_path):
    pytest.importorskip("packaging", reason="needs packaging")
    path = MODULE / "MirrorSymmetryLib" / "requirement.py"  # alone: the package imports slicer
    spec = importlib.util.spec_from_file_location("requirement", path)
    requirement = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(requirement)
    requirements = requirement.requirements
    (tmp_path / "requirements.txt").write_text("# why\nsymsurf>=0.1\nother\n")
    assert [str(each) for each in requirements(tmp_path)] == ["symsurf>=0.1", "other"]
    wheels = tmp_path / "wheels"
    wheels.mkdir()
    for name in (
        "symsurf-0.9-py3-none-any",
        "symsurf-0.10-py3-none-any",
        "symsurf-1.0-cp27-cp27m-win32",
    ):
        (wheels / f"{name}.whl").touch()
    (wheels / "README.whl").touch()
    first, second = map(str, requirements(tmp_path))
    assert first == f"symsurf @ {Path(wheels / 'symsurf-0.10-py3-none-any.whl').as_uri()}"
    assert second == "other"
