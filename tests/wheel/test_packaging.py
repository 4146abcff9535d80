"""The recipes for others' package managers, and the workflows: they name this version, and are read by their tools
where these are here."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGING = ROOT / "packaging"
RECIPE = (PACKAGING / "conda/recipe.yaml").read_text()
PORT = json.loads((PACKAGING / "vcpkg/symsurf/vcpkg.json").read_text())
VARIANTS = 'python: ["3.12"]\nc_stdlib: [sysroot]\nc_stdlib_version: ["2.28"]\n'
CMAKE = (ROOT / "CMakeLists.txt").read_text()


def test_versions_are_those_of_the_core():
    (version,) = re.findall(r"project\(symsurf VERSION ([0-9.]+)", CMAKE)
    assert PORT["version"] == version
    assert re.findall(r'version: "(.*)"', RECIPE) == [version]


def test_port_depends_on_what_the_core_finds():
    core = (ROOT / "core/CMakeLists.txt").read_text()
    found = {each.lower() for each in re.findall(r"find_package\((\w+)", core)} - {"threads"}
    named = {each for each in PORT["dependencies"] if isinstance(each, str)}
    assert named == found


@pytest.mark.parametrize("platform", ["linux-64", "linux-aarch64", "osx-arm64", "win-64"])
def test_recipe_is_read(platform):
    conda = pytest.importorskip("rattler_build", reason="py-rattler-build is not installed")
    config = conda.RenderConfig(platform=conda.PlatformConfig(target_platform=platform))
    rendered = conda.Stage0Recipe.from_yaml(RECIPE).render(
        conda.VariantConfig.from_yaml(VARIANTS), config
    )
    assert rendered[0].recipe.package.name == "symsurf"


def test_workflows_are_well_formed():
    actionlint = shutil.which("actionlint") or shutil.which(str(Path.home() / "go/bin/actionlint"))
    if actionlint is None:
        pytest.skip(
            "actionlint is not installed: go install of github.com/rhysd/actionlint/cmd/actionlint"
        )
    done = subprocess.run([actionlint], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
