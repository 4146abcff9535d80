"""Calls of symsurf with drawn clouds and parameters, and what has to hold of what they give."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from clouds import Random, cloud, faces, one_of

import symsurf
from symsurf.mirror_operations.operate import operate

ALLOWED = (symsurf.InvalidInput, symsurf.InvalidParameter, symsurf.Cancelled)
KINDS = ("detect", "operate", "detect", "operate", "detect", "analyse")
# It tries each pair of many centres and radii, as the thesis does, and is drawn seldom.
SLOW_METHOD = "sphere_thesis"
# What is not known of points without a counterpart or a reflection, and is infinite in a focus.
MAY_BE_NAN = {"vector", "distance", "signed", "tangential", "lateral", "weights", "reflection"}
MAY_BE_NAN |= {"irradiance", "vector_sd", "known"}


class NotFinite(Exception):
    """A number of a result is none."""


class Case:
    """One call: ``run`` makes it and judges what it gives; ``tell`` is told before what it is."""

    def __init__(self, seed: int, most: int, tell: Callable[[str], None]) -> None:
        self.tell = tell
        random = np.random.default_rng(seed)
        self.call = KINDS[seed % len(KINDS)]
        self.points = cloud(random, most)
        self.faces = faces(random, len(self.points), is_mesh=self.call != "detect")
        self.kind = f"{self.call}-{'cloud' if self.faces is None else 'mesh'}"
        self.random = random
        self.words = f"{len(self.points)} points"

    def run(self) -> bool:
        """Whether there is a result, not a refusal. Raises whatever is a finding."""
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            try:
                result = getattr(self, f"_{self.call}")()
            except ALLOWED:
                return False
            require_finite(result, np.isfinite(self.points).all(axis=1))
            return True

    def _detect(self) -> Any:
        random = self.random
        method = drawn_method(random)
        given = drawn_values(symsurf.methods()[method].parameters, random)
        nonfinite = "refuse" if random.integers(4) == 0 else "skip"
        self._say(method, given)
        return symsurf.detect(
            self.points, method, faces=self.faces, nonfinite=nonfinite, threads=1, **given
        )

    def _operate(self) -> Any:
        random = self.random
        name = one_of(symsurf.operations(), random)
        given = drawn_values(symsurf.operations()[name].parameters, random)
        self._say(name, given)
        found = None
        if random.integers(4):
            found = drawn_mirror(random) if random.integers(3) == 0 else self._detect()
        return operate(name, self.points, found, faces=self.faces, threads=1, **given)

    def _say(self, name: str, given: dict[str, Any]) -> None:
        self.words += f", {name} {given}"
        self.tell(self.words)

    def _analyse(self) -> Any:
        name = one_of(symsurf.analyses(), self.random)
        analysis = symsurf.analyses()[name]
        given = drawn_values(analysis.parameters, self.random)
        self._say(name, given)
        if analysis.takes_other:
            return getattr(symsurf, name)(self.points, self.points[::-1], threads=1, **given)
        return getattr(symsurf, name)(self.points, faces=self.faces, threads=1, **given)


def drawn_method(random: Random) -> str:
    method = str(one_of(symsurf.methods(), random))
    return "plane" if method == SLOW_METHOD and random.integers(4) else method


def drawn_mirror(random: Random) -> Any:
    normal = random.normal(size=3)
    if random.integers(3):
        return symsurf.Plane(normal / np.linalg.norm(normal), random.normal())
    return symsurf.Sphere(normal, abs(random.normal()) + 1e-3)


def drawn_values(described: Any, random: Random) -> dict[str, Any]:
    chosen = [parameter for parameter in described if random.integers(3) == 0]
    return {parameter.name: drawn_value(parameter, random) for parameter in chosen}


def drawn_value(parameter: Any, random: Random) -> Any:
    """Near the least or the default, since the greatest costs hours in some methods; now and then
    none that is allowed."""
    if random.integers(40) == 0:
        return one_of((None, "no", -1, 10**9, float("nan"), float("inf"), [1, 2]), random)
    if parameter.type == "boolean":
        return bool(random.integers(2))
    if parameter.type == "choice":
        return one_of(parameter.choices, random)
    if parameter.type == "integer":
        most = min(parameter.maximum, 2 * max(1, parameter.default))
        return int(random.integers(int(parameter.minimum), max(int(parameter.minimum), most) + 1))
    if parameter.type == "real":
        most = parameter.maximum if np.isfinite(parameter.maximum) else 10.0
        value = one_of((parameter.minimum, most, parameter.default), random)
        return value if random.integers(2) else float(random.uniform(parameter.minimum, most))
    return [float(number) for number in random.integers(-1, 2, size=3)]


def require_finite(result: Any, is_finite: Any) -> None:
    """Nothing is required of rows whose point is not finite, nor of points without counterpart."""
    for name, value in numbers_of(result):
        array = np.asarray(value)
        if array.dtype.kind != "f" or np.isfinite(array).all():
            continue
        last = name.rsplit(".", 1)[-1]
        if last in ("points", "given", "minimum", "maximum") or last in MAY_BE_NAN:
            continue
        is_of_points = array.ndim > 0 and len(array) == len(is_finite)
        if is_of_points and np.isfinite(array[is_finite]).all():
            continue
        raise NotFinite(f"{name}: {array[~np.isfinite(array)].size} of {array.size}")


def numbers_of(value: Any, name: str = "result") -> Iterator[tuple[str, Any]]:
    if isinstance(value, symsurf.Mirror):
        yield from numbers_of(value.numbers, f"{name}.numbers")
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            yield from numbers_of(getattr(value, field.name), f"{name}.{field.name}")
    elif isinstance(value, Mapping):
        for key, each in value.items():
            yield from numbers_of(each, f"{name}.{key}")
    elif isinstance(value, (list, tuple)):
        for index, each in enumerate(value):
            yield from numbers_of(each, f"{name}.{index}")
    elif isinstance(value, (float, np.floating, np.ndarray)):
        yield name, value
