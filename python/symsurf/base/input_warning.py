"""Warnings that name the line that called the package."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterable


class InputWarning(UserWarning):
    """Part of the input was ignored or may be interpreted differently than intended, the method is
    not suited to it, or the verdict on its mirror is "none"."""


def warn_of(messages: Iterable[str]) -> None:
    """An InputWarning each, which names the line that called the package."""
    level, frame, package = 1, sys._getframe(), __name__.split(".")[0]
    while frame.f_back and frame.f_globals["__name__"].split(".")[0] == package:
        level, frame = level + 1, frame.f_back
    for message in messages:
        warnings.warn(message, InputWarning, stacklevel=level)
