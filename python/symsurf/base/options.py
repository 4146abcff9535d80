"""The options that functions, commands and filters share, each described once."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any, TypeAlias, TypeVar

from .._core import methods


def _option(default: Any, doc: str, metavar: str = "") -> Any:
    return field(default=default, metadata={"doc": doc, "metavar": metavar})


@dataclass(frozen=True, kw_only=True)
class Reading:
    """How a file or a grid becomes points."""

    threshold: float | None = _option(
        None,
        "for masks and images: use the voxels whose value is above this number; not needed for a mask "
        "of two values",
        "NUMBER",
    )
    label: int | str | None = _option(
        None,
        "for label maps: use the voxels with this value, instead of a threshold; for a segmentation of "
        "3D Slicer (seg.nrrd) also the name of a segment",
        "NUMBER",
    )
    scalars: str | None = _option(
        None,
        "for images with several arrays: name of the array that threshold and label refer to; default "
        "is the active one",
        "NAME",
    )
    external_files: bool = _option(
        False,
        "allow files that a file refers to (glTF, NRRD, PVTP, VTKHDF) to lie anywhere; otherwise only "
        "beside it or below, links followed, and for VTKHDF none",
    )

    def of_image(self) -> dict[str, Any]:
        """What chooses points of an image, where it is given, by its name."""
        return {
            name: value
            for name, value in part(Reading, self).items()
            if name != "external_files" and value is not None
        }


@dataclass(frozen=True, kw_only=True)
class Search:
    """How a mirror is found."""

    method: str = _option("auto", f"method of detection, one of {', '.join(methods())}", "M")
    seed: int = _option(0, "random seed, for randomized methods; [0, 2^64)", "N")
    nonfinite: str = _option(
        "skip",
        '"skip": ignore points with a NaN or infinite coordinate, which get no partners; "refuse": '
        "they are an error",
        "WORD",
    )


Options: TypeAlias = type[Reading] | type[Search]


def part(kind: Options, source: object) -> dict[str, Any]:
    """What an object or a mapping has of these options, by their names."""
    if isinstance(source, Mapping):
        return {each.name: source[each.name] for each in fields(kind) if each.name in source}
    return {each.name: getattr(source, each.name) for each in fields(kind)}


def documentation(kind: Options) -> dict[str, str]:
    """What each is, by its name."""
    return {each.name: each.metadata["doc"] for each in fields(kind)}


Function = TypeVar("Function", bound=Callable[..., Any])


def documented(function: Function) -> Function:
    """The function, in whose documentation "{Reading}" and "{Search}" on lines of their own are the
    descriptions of these options."""
    kinds: tuple[Options, ...] = (Reading, Search)
    for kind in kinds:
        texts = [f"{name}: {text}." for name, text in documentation(kind).items()]
        lines = [
            textwrap.fill(text, 96, initial_indent=" " * 8, subsequent_indent=" " * 12)
            for text in texts
        ]
        function.__doc__ = (function.__doc__ or "").replace(
            f"        {{{kind.__name__}}}", "\n".join(lines)
        )
    return function
