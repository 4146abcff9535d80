"""The Properties panel as ParaView has it: headings, help, what is folded away, defaults."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

# Without a heading, on purpose: what stands above the panel's properties, or alone in its filter.
ALONE = {"Input", "Landmarks", "MirrorReflection Mirror", "Other", "PointDamage Seed"}


@pytest.fixture
def proxies(server_manager_xml: Path) -> list[str]:
    return sorted(path.stem for path in server_manager_xml.glob("*.xml"))


@pytest.fixture
def panels(proxies: list[str], run_host: Callable[..., Any]) -> dict[str, Any]:
    return run_host("pvpython", "panel.py", *proxies)


def test_every_property_has_its_heading_and_help_and_can_be_reset(
    panels: dict[str, Any], proxies: list[str]
) -> None:
    assert len(panels) == len(proxies) >= 14
    for name, panel in panels.items():
        assert all(panel["documentation"]), name
        headed = Counter(each for _, members in panel["groups"] for each in members)
        assert max(headed.values(), default=1) == 1, name
        alone = set(panel["properties"]) - set(headed)
        assert alone <= ALONE | {each for each in alone if f"{name} {each}" in ALONE}, name
        for described in panel["properties"].values():
            assert described["documentation"].strip().endswith("."), name
        assert panel["reset"] == panel["before"]
        assert panel["changed"] != panel["before"] or name == "MirrorReflection"


def test_rare_properties_are_folded_away(panels: dict[str, Any]) -> None:
    folded = {
        (name, each)
        for name, panel in panels.items()
        for each, described in panel["properties"].items()
        if described["visibility"] == "advanced"
    }
    assert {
        ("MirrorDetection", "PlaneSampleSize"),
        ("MirrorDetection", "NumberOfThreads"),
        ("MirrorAsymmetry", "RequireFound"),
        ("SymmetryAnalysis", "PartialSymmetriesDisc"),
    } <= folded
    shown = {("MirrorDetection", "Method"), ("MirrorDetection", "PlaneTolerance")}
    assert not folded & (shown | {("MirrorAsymmetry", "MaxAngle")})
    for name, panel in panels.items():
        assert sum(each[0] == name for each in folded) < len(panel["properties"]) / 2, name


def test_help_has_a_page_for_each_proxy(panels: dict[str, Any], server_manager_xml: Path) -> None:
    folder = server_manager_xml / "paraview_help"
    if not (folder / "SymsurfPlugin.qch").exists():
        pytest.skip("the plugin has no help: qttools5-dev is not installed")
    for name, panel in panels.items():
        (page,) = (path.read_text() for path in folder.glob(f"*.{name}.html"))
        for each in panel["properties"]:
            assert f">{each}</th>" in page
        for heading, _ in panel["groups"]:
            assert f"<h3>{heading}</h3>" in page
