"""What a misspelt word was perhaps meant to be."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

# How errors name the word that was given, and behind it those that are allowed.
_NAMED = re.compile(r"(?:'([\w.-]+)'|\bis ([\w.-]+))[^;']*; (?:there are|it has|allowed) (.*)")


def closest(word: str, allowed: Iterable[str]) -> str:
    """A question to add to an error; empty if nothing is near."""
    near = get_close_matches(word, list(allowed), 1)
    return f"; did you mean {near[0]}?" if near else ""


def with_suggestion(message: str) -> str:
    """An error that names a word and the allowed ones, with the nearest of these."""
    named = _NAMED.search(message)
    if named is None:
        return message
    return message + closest(named[1] or named[2], re.findall(r"[\w.-]+", named[3]))
