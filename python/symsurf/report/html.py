"""The parts of pages."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Sequence
from hashlib import sha256
from html import escape

import numpy as np
from numpy.typing import NDArray

from .._core import __version__

_STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; color: #222; margin: 0 auto; max-width: 1100px;
  padding: 1.2rem; background: #fff; }
h1 { font-size: 1.5rem; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.1rem; margin: 1.6rem 0 .4rem; }
p { margin: .3rem 0; }
.none, .error, .outlier { color: #a83244; }
/* The title and the legend of a picture, which nobody can read so small, lie outside. */
.thumbnail { display: block; width: 128px; height: 88px; overflow: hidden; border-radius: 4px; }
.thumbnail img { width: 148px; margin: -10px; }
iframe { width: 100%; height: min(620px, 80vh); border: 1px solid #ddd; border-radius: 4px; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: .2rem .9rem .2rem 0; border-bottom: 1px solid #eee;
  font-weight: normal; vertical-align: middle; }
thead th { border-bottom: 2px solid #ccc; color: #555; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
.columns { display: flex; flex-wrap: wrap; gap: 0 3rem; }
.columns > div { max-width: 100%; }
.wide { overflow-x: auto; }
svg { max-width: 100%; height: auto; }
footer { color: #777; margin-top: 2rem; font-size: .85rem; }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: .6rem; }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; border: 1px solid #ddd; border-radius: 4px; }
figcaption { color: #555; font-size: .85rem; }
.signature { display: flex; gap: 2rem; margin-top: 3.5rem; break-inside: avoid; }
.signature > div { flex: 1; border-top: 1px solid #777; padding-top: .2rem; font-size: .85rem; }
@page { margin: 16mm; }
@media print { body { padding: 0; max-width: none; font-size: 10pt; }
  iframe, .screen { display: none; } tr, svg { break-inside: avoid; } h2 { break-after: avoid; }
  thead { display: table-header-group; } .sheet { break-before: page; } }
@media (max-width: 600px) { body { padding: .6rem; } th, td { padding-right: .5rem; } }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #1b1d20; }
  th, td { border-color: #333; } thead th { color: #aaa; border-color: #555; }
  .none, .error, .outlier { color: #f08a92; } a { color: #8fb4dc; } iframe { border-color: #444; }
  svg { filter: invert(1) hue-rotate(180deg); } }
"""


class Html(str):
    """What is no text to be escaped."""


def page(title: str, parts: Iterable[str], scripts: Iterable[str] = ()) -> bytes:
    """A whole page; names that are no text show a mark in their place.

    Args:
        scripts: the only ones that run, of a page inside it.
    """
    lines = [
        "<!doctype html>",
        '<html lang="en">',
        '<head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(scripts)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(title)}</title>",
        f"<style>{_STYLE}</style></head>",
        f"<body><h1>{escape(title)}</h1>",
        *parts,
        f"<footer>symsurf {__version__}</footer>",
        "</body></html>",
    ]
    return ("\n".join(lines) + "\n").encode("utf-8", "replace")


def _policy(scripts: Iterable[str]) -> str:
    """Nothing is fetched: what a page shows is in it. No script runs but those that are named by their
    hashes; vtk.js compiles some of its own."""
    hashes = [f"'sha256-{b64encode(sha256(s.encode()).digest()).decode()}'" for s in scripts]
    allowed = " ".join([*hashes, "'unsafe-eval'"]) if hashes else "'none'"
    return (
        f"default-src 'none'; style-src 'unsafe-inline'; script-src {allowed}; "
        "img-src 'self' file: data: blob:; frame-src 'self' about: blob:; base-uri 'none'; form-action 'none'"
    )


def heading(text: str) -> str:
    return f"<h2>{escape(text)}</h2>"


def paragraph(text: str, kind: str = "") -> str:
    return f'<p class="{kind}">{escape(text)}</p>'


def table(
    rows: Iterable[Sequence[str]], names: Sequence[str] = (), numbers: bool = True, texts: int = 1
) -> str:
    """Rows of texts: the first columns to the left, those behind to the right if they are numbers.
    ``Html`` is not escaped."""
    kind = ' class="number"' if numbers else ""
    head = "".join(
        f"<th{kind if column >= texts else ''}>{escape(name)}</th>"
        for column, name in enumerate(names)
    )
    body = "".join(
        "<tr>"
        + "".join(
            f"<td{kind if column >= texts else ''}>{text if isinstance(text, Html) else escape(text)}</td>"
            for column, text in enumerate(row)
        )
        + "</tr>"
        for row in rows
    )
    thead = f"<thead><tr>{head}</tr></thead>" if names else ""
    return f'<div class="wide"><table>{thead}<tbody>{body}</tbody></table></div>'


def ranks_of(values: NDArray[np.float64]) -> list[str]:
    """Of each where it stands from below, as "3 of 12"."""
    ranks = np.searchsorted(np.sort(values), values, side="right")
    return [f"{rank} of {len(values)}" for rank in ranks]


def framed(whole_page: str, title: str) -> str:
    """A page inside the page, which sees nothing of it."""
    return (
        f'<iframe title="{escape(title)}" sandbox="allow-scripts" '
        f'srcdoc="{escape(whole_page)}"></iframe>'
    )


def pictures(drawn: Iterable[tuple[str, bytes]]) -> str:
    """PNGs with their captions, three in a row."""
    figures = (
        f'<figure><img src="data:image/png;base64,{b64encode(png).decode()}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption></figure>"
        for caption, png in drawn
    )
    return f'<div class="pictures">{"".join(figures)}</div>'


def signature(*words: str) -> str:
    """A line to write on above each word."""
    fields = "".join(f"<div>{escape(word)}</div>" for word in words)
    return f'<div class="signature">{fields}</div>'


def columns(*parts: str) -> str:
    return '<div class="columns">' + "".join(f"<div>{part}</div>" for part in parts) + "</div>"
