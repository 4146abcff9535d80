"""The options of reading and searching, made from their descriptions."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection
from dataclasses import fields
from typing import Any, TypeAlias

from ..base.options import Options, Reading, Search
from .values import number, whole

Group: TypeAlias = argparse._ActionsContainer
"""A parser, or a group of its options in its help."""


def add_options(parser: Group, kind: Options, names: Collection[str] = ()) -> None:
    """One for each, or for those of these names."""
    for each in fields(kind):
        if names and each.name not in names:
            continue
        is_flag = isinstance(each.default, bool)
        default = "" if is_flag or each.default is None else "; default %(default)s"
        form: dict[str, Any] = (
            {"action": "store_true"} if is_flag else {"metavar": each.metadata["metavar"]}
        )
        parser.add_argument(
            f"--{each.name.replace('_', '-')}",
            default=each.default,
            help=f"{each.metadata['doc']}{default}",
            **form,
        )


def given_options(arguments: argparse.Namespace) -> dict[str, Any]:
    """Those on the command line, in their types."""
    values = vars(arguments)
    return {
        each.name: _CONVERSIONS.get(each.name, _same)(values[each.name])
        for kind in (Reading, Search)
        for each in fields(kind)
        if each.name in values
    }


def _same(value: Any) -> Any:
    return value


def _threshold(text: str | None) -> Any:
    return None if text is None else number(text)


def _label(text: str | None) -> Any:
    return int(text) if text is not None and text.lstrip("-").isdecimal() else text


_CONVERSIONS: dict[str, Callable[[Any], Any]] = {
    "threshold": _threshold,
    "label": _label,
    "seed": lambda value: whole(str(value)),
}
