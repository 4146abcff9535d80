"""Pages that are read in the repository: tables as the descriptions are, links that lead somewhere, no templates."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from conftest import ROOT

PAGES = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "python/**/*.md", "packaging/**/*.md")
    for path in ROOT.glob(pattern)
)
README = ROOT / "README.md"


def prose(page: Path) -> str:
    """The page without code."""
    return re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(), flags=re.DOTALL)


def links(page: Path) -> Iterator[tuple[str, Path, str]]:
    """Those to files: as written, the file, and the place in it."""
    for link in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if not re.match(r"\w+:", link):
            path, _, place = link.partition("#")
            yield link, (page.parent / path).resolve() if path else page, place


def places(page: Path) -> set[str]:
    """What headings are linked by, as a repository's web page makes it."""
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    plain = [re.sub(r"\[([^]]*)\]\([^)]*\)|[`*]", r"\1", each).strip().lower() for each in headings]
    return {re.sub(r"[^\w\- ]", "", each).replace(" ", "-") for each in plain}


def test_made_blocks_are_what_is_described():
    pytest.importorskip("pyvista", reason="the class of mesh.symmetry is among them")
    command = [sys.executable, str(ROOT / "docs" / "tables.py"), "--check"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"docs/tables.py writes them: {done.stdout}{done.stderr}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for link, target, place in links(page):
        assert target.exists(), link
        assert not place or target.suffix != ".md" or place in places(target), link


def test_no_page_is_raw():
    """But two of the site alone, which show README and CONTRIBUTING.md."""
    site = {ROOT / "docs" / "index.md", ROOT / "docs" / "developer" / "contributing.md"}
    for page in PAGES:
        text = page.read_text()
        assert not re.search(r"\{\{.*\}\}", text), page
        assert page in site or not re.search(r"^(```\{|:::)", text, re.MULTILINE), page
        assert not site & {target for _, target, _ in links(page)}, page


def test_the_first_screen_says_what_to_type():
    first = "\n".join(README.read_text().splitlines()[:25])
    assert "](docs/images/" in first and "$ symsurf detect" in first and "pip install" in first
    (example,) = re.findall(r"```python\n(.*?)```", first, re.DOTALL)
    assert (
        len(
            [
                line
                for line in example.splitlines()
                if line.startswith(("result", "print", "symsurf"))
            ]
        )
        == 3
    )


def test_the_changelog_is_short():
    assert len((ROOT / "CHANGELOG.md").read_text().splitlines()) <= 30
