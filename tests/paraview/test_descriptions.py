"""The server-manager XML, VTK's setters and getters and the core's descriptions are one."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

import symsurf

ELEMENTS = {
    "boolean": ("IntVectorProperty", "1"),
    "integer": ("IntVectorProperty", "1"),
    "real": ("DoubleVectorProperty", "1"),
    "choice": ("StringVectorProperty", "1"),
    "direction": ("DoubleVectorProperty", "3"),
    "position": ("DoubleVectorProperty", "3"),
}


# Of every filter that takes a shape.
INPUT = {"Input", "ImageScalars", "ImageThreshold"}


def camel_case(*names: str) -> str:
    return "".join(word.capitalize() for name in names for word in name.split("_"))


def described() -> list[tuple[str, str, symsurf.Parameter]]:
    """Property, method and description of every parameter there is."""
    return [
        (camel_case(method.name, parameter.name), method.name, parameter)
        for method in symsurf.methods().values()
        for parameter in method.parameters
    ]


def default(parameter: symsurf.Parameter) -> Any:
    if parameter.type in ("direction", "position"):
        return [0.0, 0.0, 0.0]
    return parameter.default


def another(parameter: symsurf.Parameter) -> Any:
    """An allowed value that is not the default."""
    if parameter.type == "boolean":
        return not parameter.default
    if parameter.type in ("direction", "position"):
        return [1.0, -2.0, 0.5]
    if parameter.type == "choice":
        return parameter.range.split(" | ")[-1]
    low, high = parameter.range.strip("[]()").split(", ")
    return type(parameter.default)(float(low if float(low) != parameter.default else high))


def xml_properties(path: Path) -> dict[str, ElementTree.Element]:
    return {e.get("name"): e for e in ElementTree.parse(path).iter() if e.get("command")}


@pytest.fixture
def proxy(server_manager_xml: Path) -> dict[str, ElementTree.Element]:
    return xml_properties(server_manager_xml / "MirrorDetection.xml")


def test_no_property_is_without_a_description(proxy: dict[str, ElementTree.Element]) -> None:
    names = {name for name, _, _ in described()}
    assert len(names) == len(described())
    own = {"Method", "ShowCandidates", "UseNormals", "UseFaces", "RefuseNonfinite"}
    assert set(proxy) == names | INPUT | own | {"Seed", "NumberOfThreads"}


@pytest.mark.parametrize(
    "name", ["MirrorDetection", "MirrorReflection", "PointDamage", "SymmetryAnalysis"]
)
def test_every_filter_takes_the_same_shapes(name: str, server_manager_xml: Path) -> None:
    proxy = xml_properties(server_manager_xml / f"{name}.xml")
    assert set(proxy) >= INPUT
    types = [each.get("value") for each in proxy["Input"].iter("DataType")]
    assert types == ["vtkPointSet", "vtkImageData", "vtkRectilinearGrid"]
    for choice in ("ImageScalars", "ImageThreshold"):
        decorator = proxy[choice].find("Hints/PropertyWidgetDecorator")
        assert decorator.get("name") == "vtkImageData vtkRectilinearGrid"


def test_surface_points_are_hidden_at_first(server_manager_xml: Path) -> None:
    file = ElementTree.parse(server_manager_xml / "MirrorDetection.xml")
    ports = {each.get("name"): each.get("index") for each in file.iter("OutputPort")}
    (view,) = file.iter("View")
    assert (view.get("type"), view.get("port")) == ("None", ports["Surface Points"])


def test_test_data_has_a_menu_of_its_own(server_manager_xml: Path) -> None:
    for path in server_manager_xml.glob("*.xml"):
        (menu,) = ElementTree.parse(path).iter("ShowInMenu")
        is_test_data = path.stem in ("MirrorSampleSource", "PointDamage")
        assert menu.get("category") == ("Symmetry Test Data" if is_test_data else "Symmetry")


def test_method_lists_the_methods(proxy: dict[str, ElementTree.Element]) -> None:
    offered = [item.get("value") for item in proxy["Method"].iter("String")]
    assert offered == list(symsurf.methods())
    assert proxy["Method"].get("default_values") == offered[0] == "auto"
    for method in symsurf.methods().values():
        assert method.summary in proxy["Method"].findtext("Documentation")


@pytest.mark.parametrize(("name", "method", "parameter"), described())
def test_xml_is_the_description(
    proxy: dict[str, ElementTree.Element], name: str, method: str, parameter: symsurf.Parameter
) -> None:
    check(proxy[name], name, parameter)
    decorator = proxy[name].find("Hints/PropertyWidgetDecorator")
    assert (decorator.get("property"), decorator.get("value")) == ("Method", method)


def test_xml_of_the_analyses_is_their_descriptions(server_manager_xml: Path) -> None:
    proxy = xml_properties(server_manager_xml / "SymmetryAnalysis.xml")
    own = INPUT | {
        "Analysis",
        "Other",
        "UseFaces",
        "ColourArray",
        "RefuseNonfinite",
        "NumberOfThreads",
    }
    described = {
        camel_case(analysis.name, parameter.name): (analysis.name, parameter)
        for analysis in symsurf.analyses().values()
        for parameter in analysis.parameters
    }
    assert set(proxy) == own | set(described)
    offered = [item.get("value") for item in proxy["Analysis"].iter("String")]
    assert offered == list(symsurf.analyses())
    for name, (analysis, parameter) in described.items():
        check(proxy[name], name, parameter)
        decorator = proxy[name].find("Hints/PropertyWidgetDecorator")
        assert (decorator.get("property"), decorator.get("value")) == ("Analysis", analysis)


@pytest.mark.parametrize("operation", symsurf.operations().values(), ids=lambda each: each.name)
def test_xml_is_the_description_of_the_operation(
    server_manager_xml: Path, operation: symsurf.Operation
) -> None:
    path = server_manager_xml / f"{proxy_of(operation)}.xml"
    source = next(ElementTree.parse(path).iter("ColourRangesProxy"))
    assert source.get("label") == operation.title.title()
    assert source.get("class") == f"vtk{proxy_of(operation)}"
    assert source.find("Documentation").get("long_help") == operation.summary
    signed = [hint.get("array") for hint in source.iter("ColourRange")]
    assert signed == [
        proxy_of(operation) + camel_case(array.name)
        for array in operation.arrays
        if array.is_signed
    ]
    proxy = xml_properties(path)
    for parameter in operation.parameters:
        name = camel_case(parameter.name)
        check(proxy[name], name, parameter)
    check(proxy["RequireFound"], "RequireFound", symsurf._core.require_found_parameter())
    own = INPUT | {"Mirror", "Method", "RequireFound", "Kinds", "NumberOfThreads"}
    own |= {"MaskArray"} if operation.takes_mask else set()
    own |= {"Other"} if operation.takes_other else set()
    own |= {"Landmarks"} if "pairing" in {each.name for each in operation.parameters} else set()
    assert set(proxy) == own | {camel_case(each.name) for each in operation.parameters}
    assert proxy["Mirror"].find("Hints/Optional") is not None
    offered = [item.get("value") for item in proxy["Method"].iter("String")]
    assert offered == list(symsurf.methods())


def check(element: ElementTree.Element, name: str, parameter: symsurf.Parameter) -> None:
    assert (element.tag, element.get("number_of_elements")) == ELEMENTS[parameter.type]
    assert element.get("command") == f"Set{name}"
    text = element.get("default_values")
    if parameter.type == "choice":
        assert text == parameter.default
        offered = [item.get("value") for item in element.iter("String")]
        assert offered == parameter.range.split(" | ")
    else:
        assert [float(x) for x in text.split()] == list(
            map(float, default(parameter) if " " in text else [parameter.default])
        )
    if parameter.type in ("integer", "real"):
        domain = element.find(
            "IntRangeDomain" if parameter.type == "integer" else "DoubleRangeDomain"
        )
        low, high = map(float, parameter.range.strip("[]()").split(", "))
        assert float(domain.get("min", "-inf")) == low
        assert float(domain.get("max", "inf")) == high
    doc = element.findtext("Documentation")
    assert parameter.doc in doc
    assert parameter.unit in doc


def test_setters_and_getters_are_the_description(run_host: Callable[..., Any]) -> None:
    values = {name: another(parameter) for name, _, parameter in described()}
    seen = run_host("pvpython", "properties.py", json.dumps({"MirrorDetection": values}))
    seen = seen["MirrorDetection"]
    assert seen["before"] == {name: default(parameter) for name, _, parameter in described()}
    assert seen["after"] == values


def default_in_xml(element: ElementTree.Element) -> Any:
    text = element.get("default_values")
    if element.tag == "StringVectorProperty":
        return text
    number = float if element.tag == "DoubleVectorProperty" else int
    numbers = [number(word) for word in text.split()]
    return numbers if len(numbers) > 1 else numbers[0]


def another_in_xml(element: ElementTree.Element) -> Any:
    offered = [item.get("value") for item in element.iter("String")]
    if offered:
        return offered[-1]
    if element.find("ArrayListDomain") is not None:
        return "Normals"
    default = default_in_xml(element)
    if isinstance(default, str):
        return "wind=vector"
    if element.find("BooleanDomain") is not None:
        return 1 - default
    return [1.0, 2.0, 3.0] if isinstance(default, list) else default + 1


def proxy_of(operation: symsurf.Operation) -> str:
    return camel_case(operation.title.replace(" ", "_"))


OPERATIONS = [proxy_of(operation) for operation in symsurf.operations().values()]


def test_xml_and_vtk_agree(server_manager_xml: Path, run_host: Callable[..., Any]) -> None:
    names = ["MirrorDetection", "MirrorSampleSource", "PointDamage", *OPERATIONS]
    proxies = {name: xml_properties(server_manager_xml / f"{name}.xml") for name in names}
    for properties in proxies.values():
        for without_getter in ("Input", "Mirror", "Other", "Landmarks", "ImageScalars"):
            properties.pop(without_getter, None)
    values = {
        name: {key: another_in_xml(element) for key, element in properties.items()}
        for name, properties in proxies.items()
    }
    seen = run_host("pvpython", "properties.py", json.dumps(values))
    for name, properties in proxies.items():
        defaults = {key: default_in_xml(element) for key, element in properties.items()}
        assert seen[name] == {"before": defaults, "after": values[name]}, name
