"""Running an operation of the core on what Python users have."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import InvalidInput, InvalidParameter, Mirror, Parameter
from ..base.input_warning import warn_of
from ..base.lengths import as_fractions, diagonal_of
from ..base.options import Reading, Search, part
from ..base.progress import Progress, share
from ..detection import detect
from ..detection.repeating import deviations, half_samples, require_repeat
from ..reading.inputs import Input, as_input, refuses, require_finite
from ..results import Axis, OperationResult, Result, Transferred, found_mirror, mirror_of
from ..results.inspection import limits_of
from ..results.operation_results import RESULTS, Asymmetry, require_one_a_point
from ..shapes.kinds import require_kinds

FOUND_AT = 0.8
"""The share of the progress that finding the mirror takes."""


def operate(
    name: str,
    shape: object,
    mirror: Result | Mirror | Axis | str | None = None,
    *,
    other: object = None,
    mask: ArrayLike | None = None,
    pairs: ArrayLike | None = None,
    pairs_sd: ArrayLike = 0,
    faces: ArrayLike | None = None,
    kinds: Mapping[str, str] | None = None,
    bands: ArrayLike | None = None,
    repeat: int = 0,
    absolute: bool = False,
    require_found: bool = False,
    method: str = "auto",
    seed: int = 0,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: Any,
) -> OperationResult:
    """Runs one of ``operations()``; arguments and errors are those of the function of that name."""
    search = Search(**part(Search, locals()))
    reading = Reading(**part(Reading, locals()))
    given = as_input(shape, faces, reading)
    if refuses(nonfinite):
        require_finite(given.points)
    known_kinds = require_kinds(kinds)
    if bands is not None:
        limits_of(bands)
    require_repeat(repeat)
    described = _core.operations()[name].parameters
    if any(each.name == "symmetry" for each in described):
        mirror, parameters = _named_symmetry(mirror, parameters)
    _require_conditions(parameters, described)
    if absolute:
        parameters = as_fractions(parameters, described, lambda: diagonal_of(given.points))
    used, found, searched, own = None, None, None, progress
    second = Input(None, None) if other is None else as_input(other, None, reading)
    if other is not None and mirror is not None:
        raise InvalidParameter("mirror and other are both given; allowed is one of them")
    needs_mirror = other is None and _core.needs_mirror(name, parameters)
    if mirror is not None or not needs_mirror:
        require_no_search(search)
    if needs_mirror:
        if mirror is None:
            finding, own = share(progress, 0, FOUND_AT), share(progress, FOUND_AT, 1)
            options = part(Search, search)
            found = detect(
                given.points,
                faces=given.faces,
                weights=given.shape.weights,
                threads=threads,
                progress=finding,
                **options,
            )
            searched = found
            used, warning = found_mirror(found, require_found)
            warn_of([warning] if warning else [])
        elif isinstance(mirror, Result) and (require_found or repeat):
            searched = mirror
            used = found_mirror(mirror, require_found)[0]
        else:
            used = mirror_of(mirror)
        # The way back from a straightened shape is laid out over it.
        if used.footprint is None and not _core.operations()[name].takes_any_mirror:
            used = _core.make_mirror(used.kind, used.numbers, given.points)
    started = time.perf_counter()
    landmarks = _landmark_pairs(pairs, pairs_sd, given.points)

    def made_over(mirror: Mirror | None, report: Progress | None) -> dict[str, Any]:
        return _core.operate(
            name,
            given.points,
            given.faces,
            mirror,
            _mask_of(mask),
            threads,
            report,
            parameters,
            landmarks,
            second.points,
            second.faces,
        )

    made = made_over(used, own)
    if repeat:
        made["statistics"] |= _repeated(given.points, repeat, searched, seed, threads, made_over)
    if require_found and made["statistics"].get("pair_verdict") == "none":
        raise InvalidInput(made["statistics"]["warning"])
    if "warning" in made["statistics"]:
        warn_of([made["statistics"]["warning"]])
    result = RESULTS[name].from_fields(
        made
        | {
            "seconds": time.perf_counter() - started,
            "given": given.as_shape(made["given"]),
            "mirror": used,
            "found": found,
            "kinds": known_kinds,
        }
    )
    return result if bands is None else cast(Asymmetry, result).with_bands(bands)


def _repeated(
    points: NDArray[np.float64],
    repeat: int,
    found: Result | None,
    seed: int,
    threads: int,
    made_over: Callable[[Mirror | None, Progress | None], dict[str, Any]],
) -> dict[str, Any]:
    """The deviations of the mirror and of the asymmetry over it."""
    if found is None:
        raise InvalidParameter(
            "repeat is given beside a mirror; allowed is with one that is found, or the result of "
            "its detection"
        )
    halves = half_samples(
        points,
        repeat,
        found.mirror,
        method=found.method,
        parameters=found.parameters,
        seed=seed,
        threads=threads,
    )
    measured = []
    for rows, each in halves:
        if each.mirror is not None:
            distance = made_over(each.mirror, None)["arrays"]["distance"][rows]
            each = each._replace(rms=float(np.sqrt(np.nanmean(np.square(distance)))))
        measured.append(each)
    return deviations(measured, points)


def with_values(made: Transferred, values: Any) -> Transferred:
    """The result with the values that its points then have of those of the input's points, an array
    or a dictionary of arrays. Raises InvalidInput where one is not one value per point."""
    if values is None:
        return made
    if isinstance(values, Mapping):
        carried: Any = {name: _carried(made, each, name) for name, each in values.items()}
    else:
        carried = _carried(made, values, "values")
    return replace(made, values=carried)


def _carried(made: OperationResult, values: ArrayLike, name: object) -> NDArray[Any]:
    array = np.asarray(values)
    require_one_a_point(array, made.given, name)
    return made.carried(array, made.kinds.get(str(name), "scalar"), name)


def _named_symmetry(
    result: Result | Mirror | Axis | str | None, parameters: dict[str, Any]
) -> tuple[Result | Mirror | Axis | str | None, dict[str, Any]]:
    """Both as the core takes them: the symmetry is given as an object in place of its name, or as the
    result; an axis becomes parameters."""
    given = parameters.get("symmetry")
    if given is not None and not isinstance(given, str):
        if not isinstance(given, (Result, Mirror, Axis)):
            raise InvalidParameter(
                f"symmetry is of type {type(given).__name__}; allowed is 'mirror', 'axis', a Result, a "
                "Mirror or an Axis"
            )
        if result is not None:
            raise InvalidParameter("mirror and symmetry are both given; allowed is one of them")
        result, parameters = given, parameters | {"symmetry": "mirror"}
    if not isinstance(result, Axis):
        return result, parameters
    own = {
        "axis_point": result.point,
        "axis_direction": result.direction,
        "axis_order": result.order,
    }
    if twice := [name for name in own if name in parameters]:
        raise InvalidParameter(f"an axis is given and {twice[0]}, too; allowed is one of them")
    if not np.any(result.direction):
        raise InvalidParameter("the axis has the direction (0, 0, 0); allowed is another")
    return None, parameters | own | {"symmetry": "axis"}


def _require_conditions(parameters: Mapping[str, Any], described: Iterable[Parameter]) -> None:
    """That parameters which count with another's value alone are not given beside other values."""
    values = {each.name: parameters.get(each.name, each.default) for each in described}
    for each in described:
        if each.condition is None or np.array_equal(values[each.name], each.default):
            continue
        other, value = each.condition
        if values[other] != value:
            raise InvalidParameter(
                f"{each.name} is {values[each.name]!r} beside the {other} {values[other]!r}; allowed "
                f"with {other}={value!r}"
            )


def _mask_of(mask: ArrayLike | None) -> NDArray[np.float64] | None:
    if mask is None:
        return None
    try:
        values = np.asarray(mask, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"mask cannot be read as real numbers: {error}") from None
    if values.ndim != 1:
        raise InvalidInput(f"mask has shape {values.shape}; allowed is (n,)")
    return values


def _landmark_pairs(
    pairs: ArrayLike | None, deviations: ArrayLike, points: NDArray[np.float64]
) -> NDArray[np.float64] | None:
    """Rows of both places and their standard deviation, as the core takes them."""
    if pairs is None:
        return None
    places = np.asarray(pairs)
    if places.dtype.kind in "iu" and places.ndim == 2 and places.shape[1] == 2:
        if places.size and not (0 <= places.min() and places.max() < len(points)):
            raise InvalidInput(
                f"pairs name the points {places.min()} to {places.max()}; allowed is 0 to "
                f"{len(points) - 1}"
            )
        places = points[places]
    if places.dtype.kind not in "fiu" or places.ndim != 3 or places.shape[1:] != (2, 3):
        raise InvalidInput(
            f"pairs have shape {places.shape} and type {places.dtype}; allowed is (k, 2), whole "
            "numbers, and (k, 2, 3)"
        )
    rows = np.empty((len(places), 7))
    rows[:, :6] = places.reshape(-1, 6)
    try:
        rows[:, 6] = deviations
    except (TypeError, ValueError):
        raise InvalidInput(
            f"pairs_sd must be a number or one for each of the {len(places)} pairs"
        ) from None
    return rows


def require_no_search(search: Search) -> None:
    """Raises InvalidParameter where something is said of a search that is not made."""
    for name in ("method", "seed"):
        if (value := getattr(search, name)) != getattr(Search(), name):
            raise InvalidParameter(
                f"{name} is {value!r}; allowed is its default, as no mirror is searched"
            )
