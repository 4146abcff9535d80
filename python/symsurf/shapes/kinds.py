"""Transformation rules of attributes: how vectors, normals, tensors and rotations go along where points move."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .._core import AttributeTransform, InvalidInput, InvalidParameter

Placed = Callable[[NDArray[np.float64], NDArray[np.float64]], NDArray[np.float64]]
"""Positions (n, 3) after a map, given its Jacobians at the points that have them."""

COMPONENTS: dict[str, tuple[int, ...]] = {
    "scalar": (),
    "label": (),
    "weight": (),
    "position": (3,),
    "vector": (3,),
    "normal": (3,),
    "tensor": (6, 9),
    "quaternion": (4,),
    "harmonics": (9, 24, 45),
    "ellipsoid": (7,),
}
"""The kinds of arrays, with how many components each may have; none: any."""

UNDIRECTED = ("scalar", "label", "weight")


class Carry(Protocol):
    """Values of points from those of others, by the rule of a kind."""

    def __call__(self, values: NDArray[Any], kind: str, name: object) -> NDArray[Any]: ...


def require_kinds(kinds: Mapping[str, str] | None) -> dict[str, str]:
    """Raises InvalidParameter for an unknown kind."""
    for name, kind in (kinds or {}).items():
        if kind not in COMPONENTS:
            raise InvalidParameter(
                f"kinds gives {name!r} the kind {kind!r}; allowed are {', '.join(COMPONENTS)}"
            )
    return dict(kinds or {})


def is_ambiguous(name: str, values: NDArray[Any]) -> bool:
    """Whether an array of no known kind looks as if it had directions."""
    is_colour = any(word in name.lower() for word in _COLOURS)
    is_directed = values.dtype.kind == "f" and values.shape[1:] in ((3,), (9,), (3, 3))
    return bool(name) and is_directed and not is_colour


_COLOURS = ("colo", "rgb", "coord", "texture", "uv")


def kept_as_number(name: str) -> str:
    """What to say of such an array where directions change."""
    return (
        f"{name} is not turned with the shape, as its kind is unknown; allowed are "
        f'kinds={{"{name}": "vector"}}, "normal", "tensor" or "scalar"'
    )


def column_groups(
    names: Sequence[str], kinds: Mapping[str, str]
) -> list[tuple[str, str, list[str]]]:
    """Columns of a table that are one array with directions: its name, its kind and the columns. Those
    of the kinds, and the rotations and harmonics of Gaussian splats."""
    groups: list[tuple[str, str, list[str]]] = []
    if set(_ELLIPSOID) <= set(names):
        kinds = {"f_rest": "harmonics"} | dict(kinds)
        groups.append(("rot", "ellipsoid", [*_ELLIPSOID]))
    for name, kind in kinds.items():
        sizes = sorted(COMPONENTS[kind], reverse=True)
        forms = [[f"{name}{mark}{end}" for end in "xyz"] for mark in ("_", "", ":") if 3 in sizes]
        forms += [[f"{name}{mark}{i}" for i in range(n)] for n in sizes for mark in ("_", "", ":")]
        there = (form for form in forms if set(form) <= set(names))
        if (columns := next(there, None)) is not None:
            groups.append((name, kind, columns))
    return groups


_ELLIPSOID = [*(f"rot_{i}" for i in range(4)), *(f"scale_{i}" for i in range(3))]


def unknown_groups(names: Sequence[str], kinds: Mapping[str, str]) -> list[str]:
    """The names of triples of columns, such as wind_x, wind_y and wind_z, that may be directions."""
    stems = [name[:-1] for name in names if name.endswith("x") and name not in ("x", "nx")]
    return [
        stem.rstrip("_:")
        for stem in stems
        if {stem + "y", stem + "z"} <= set(names) and stem.rstrip("_:") not in kinds
    ]


def carried_by(
    by: AttributeTransform,
    values: NDArray[Any],
    kind: str,
    placed: Placed,
    rows: NDArray[np.int64],
    shares: NDArray[np.float64] | None = None,
    name: object = "values",
) -> NDArray[Any]:
    """Values (k, ...) with directions after their points were moved, as real numbers of their type.

    Args:
        placed: what becomes of positions.
        rows: (n, m) the points that each value lies between; ``shares``: what each of them counts.

    Returns: positions p as placed(p); vectors, normals and symmetric tensors by the core's rule,
        ``symsurf/attributes.h``; quaternions (w, x, y, z) of rotations R as those of M R, or
        M R diag(-1, 1, 1) where M, the orthogonal matrix closest to the Jacobian J, is a reflection;
        coefficients of spherical harmonics of degrees 1 to 3 as those of the function turned by M;
        ellipsoids, a quaternion and the logarithms of three semi-axes, as the ellipsoids that J makes
        of them.

    Raises InvalidInput for another number of components.
    """
    flat = values.reshape(len(values), -1)
    if kind != "harmonics" or values.dtype.kind != "f":  # of splats these are many, and single
        flat = flat.astype(float, copy=False)
    if flat.shape[1] not in COMPONENTS[kind]:
        allowed = " or ".join(map(str, COMPONENTS[kind]))
        raise InvalidInput(
            f"{name} of the kind {kind} have {flat.shape[1]} components; allowed is {allowed}"
        )
    if kind in ("vector", "normal", "tensor"):
        made = by(flat, kind)
    else:
        made = _moved(by, flat, kind, placed, rows, shares)
    numbers = values.dtype if values.dtype.kind == "f" else float
    return made.reshape(-1, *values.shape[1:]).astype(numbers, copy=False)


def _moved(
    by: AttributeTransform,
    flat: NDArray[Any],
    kind: str,
    placed: Placed,
    rows: NDArray[np.int64],
    shares: NDArray[np.float64] | None,
) -> NDArray[Any]:
    def map_(values: NDArray[Any], jacobians: NDArray[np.float64]) -> NDArray[Any]:
        return placed(values, jacobians) if kind == "position" else turned(values, kind, jacobians)

    moves, found = by.jacobian_of >= 0, by.jacobians
    own = found[0] if len(found) == 1 else found[by.jacobian_of[moves]]
    if shares is None and moves.all():
        is_same = len(rows) == len(flat) and (rows[:, 0] == np.arange(len(flat))).all()
        return map_(flat if is_same else flat[rows[:, 0]], own)
    each = flat[rows]
    each[moves] = map_(each[moves], own)
    return each[:, 0] if shares is None else _mean(each, kind, shares)


def turned(
    values: NDArray[np.float64], kind: str, jacobians: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Quaternions, harmonics or ellipsoids (n, ...) by Jacobians (3, 3) or (n, 3, 3)."""
    if kind == "ellipsoid":
        return _stretched(jacobians, values)
    closest = orthogonal(jacobians)
    return _turned(closest, values) if kind == "quaternion" else _harmonics(closest, values)


def _mean(each: NDArray[np.float64], kind: str, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    if kind in ("quaternion", "ellipsoid"):  # q and -q are one rotation
        turns = each[..., :4]
        turns *= np.where((turns * turns[:, :1]).sum(axis=-1, keepdims=True) < 0, -1, 1)
    counts = shares[..., None]
    made = (np.where(counts == 0, 0, each) * counts).sum(axis=1)
    if kind != "quaternion":
        return made
    return with_lengths(made, (np.linalg.norm(each, axis=-1) * (shares > 0)).max(axis=1))


def with_lengths(vectors: NDArray[np.float64], lengths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows of these lengths; those of length 0 stay."""
    own = np.linalg.norm(vectors, axis=1)
    factors = np.divide(lengths, own, out=np.ones_like(own), where=(own != 0))
    return vectors * factors[:, None]


def orthogonal(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """The orthogonal matrices closest to those given; NaN of what is not finite."""
    finite = np.isfinite(matrices).all(axis=(-2, -1), keepdims=True)
    left, _, right = np.linalg.svd(np.where(finite, matrices, np.eye(3)))
    return np.where(finite, left @ right, np.nan)


def _turned(matrices: NDArray[np.float64], quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of M R, or of M R diag(-1, 1, 1) = (-M) R diag(1, -1, -1) where M is a reflection: behind
    R half a turn about x."""
    reflects = np.linalg.det(matrices) < 0
    proper = np.where(reflects[..., None, None], -matrices, matrices)
    made = _product(_quaternion(proper), quaternions)
    return np.where(reflects[..., None], _product(made, np.array([0.0, 1, 0, 0])), made)


def _stretched(
    matrices: NDArray[np.float64], ellipsoids: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Ellipsoids keep their axes where the map is rigid; else J R S has others."""
    made = ellipsoids.copy()
    made[:, :4] = _turned(orthogonal(matrices), ellipsoids[:, :4])
    off = np.abs(matrices @ np.swapaxes(matrices, -1, -2) - np.eye(3)).max(axis=(-2, -1))
    rows = np.broadcast_to((off > _RIGID) & np.isfinite(off), len(made))
    if not rows.any():
        return made
    scales = np.exp(ellipsoids[rows, None, 4:])
    own = np.broadcast_to(matrices, (len(made), 3, 3))[rows]
    axes, lengths, _ = np.linalg.svd(own @ (_rotation(ellipsoids[rows, :4]) * scales))
    axes[..., 0] *= np.sign(np.linalg.det(axes))[:, None]
    sizes = np.linalg.norm(ellipsoids[rows, :4], axis=1, keepdims=True)
    made[rows] = np.hstack([_quaternion(axes) * sizes, np.log(lengths)])
    return made


_RIGID = 1e-9  # of J J^T: more than differences of a rigid map are off


def _rotation(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3, 3): the images of the unit vectors are q e q* / |q|^2."""
    conjugate = quaternions * (1, -1, -1, -1)
    images = [_product(_product(quaternions, np.eye(4)[i]), conjugate)[:, 1:] for i in range(1, 4)]
    return np.stack(images, axis=-1) / np.square(quaternions).sum(axis=1)[:, None, None]


def _product(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    w, v, a, u = first[..., :1], first[..., 1:], second[..., :1], second[..., 1:]
    real = w * a - (v * u).sum(axis=-1, keepdims=True)
    return np.concatenate([real, w * u + a * v + np.cross(v, u)], axis=-1)


def _quaternion(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 4) of rotations: the longest row of 4 q q^T."""
    r = rotations
    trace = np.trace(r, axis1=-2, axis2=-1)
    outer = np.empty((*trace.shape, 4, 4))
    outer[..., 0, 0] = 1 + trace
    odd = [r[..., (i + 2) % 3, (i + 1) % 3] - r[..., (i + 1) % 3, (i + 2) % 3] for i in range(3)]
    outer[..., 0, 1:] = outer[..., 1:, 0] = np.stack(odd, axis=-1)
    outer[..., 1:, 1:] = r + np.swapaxes(r, -1, -2) + (1 - trace)[..., None, None] * np.eye(3)
    best = np.argmax(np.diagonal(outer, axis1=-2, axis2=-1), axis=-1)
    row = np.take_along_axis(outer, best[..., None, None], axis=-2)[..., 0, :]
    return row / np.linalg.norm(row, axis=-1, keepdims=True)


def _harmonics(
    matrices: NDArray[np.float64], coefficients: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Of c the c' with c' Y(M d) = c Y(d) for all directions d, found from enough of them. Coefficients
    are those of three colours, one after the other, as splats have them."""
    count = coefficients.shape[1] // 3
    turns = np.arange(2 * _HARMONICS) * np.pi * (3 - np.sqrt(5))
    heights = np.linspace(-1, 1, 2 * _HARMONICS + 1)[:-1] + 0.5 / _HARMONICS
    radii = np.sqrt(1 - heights**2)
    directions = np.column_stack([radii * np.cos(turns), radii * np.sin(turns), heights])
    inverse = np.linalg.pinv(_basis(directions)[:, :count])
    before = directions @ matrices  # the rows M^T d
    turn = (inverse @ _basis(before)[..., :count]).astype(coefficients.dtype)
    if turn.ndim == 2:  # columns at once, which lie one after the other in tables
        return (turn @ coefficients.T.reshape(3, count, -1)).reshape(3 * count, -1).T
    colours = coefficients.reshape(-1, 3, count)
    return (colours @ np.swapaxes(turn, -1, -2)).reshape(coefficients.shape)


_HARMONICS = 15


def _basis(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(..., 15) real spherical harmonics of degrees 1 to 3 in the order and with the signs that 3D
    Gaussian Splatting (Kerbl et al. 2023) gives them."""
    x, y, z = np.moveaxis(directions, -1, 0)
    xx, yy, zz = x * x, y * y, z * z
    first = [-y, z, -x]
    second = [x * y, -y * z, (2 * zz - xx - yy) / np.sqrt(12), -x * z, (xx - yy) / 2]
    third = [
        -y * (3 * xx - yy) / np.sqrt(24),
        x * y * z,
        -y * (4 * zz - xx - yy) / np.sqrt(40),
        z * (2 * zz - 3 * xx - 3 * yy) / np.sqrt(60),
        -x * (4 * zz - xx - yy) / np.sqrt(40),
        z * (xx - yy) / 2,
        -x * (xx - 3 * yy) / np.sqrt(24),
    ]
    scales = np.sqrt(np.array([3] * 3 + [15] * 5 + [105] * 7) / (4 * np.pi))
    return np.stack([*first, *second, *third], axis=-1) * scales
