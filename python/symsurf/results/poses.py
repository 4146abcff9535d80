"""Poses of a symmetric object: which of the equivalent ones is nearest to another, and the tables that
pose estimators read its symmetries in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter
from .elements import Axis

Matrices = NDArray[np.float64]

_RIGID = 1e-3  # that columns of a rotation in single precision, multiplied many times, are off
_SAME = 1e-9  # of traces: what differs by rounding is as near


def rigid(name: str, given: ArrayLike) -> Matrices:
    """(k, 4, 4) of one matrix or of several. Raises InvalidInput unless all are rigid motions."""
    try:
        poses = np.array(given, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{name} holds no numbers ({error}); allowed is (4, 4)") from error
    if poses.ndim not in (2, 3) or poses.shape[-2:] != (4, 4):
        raise InvalidInput(f"{name} has shape {poses.shape}; allowed is (4, 4) or (k, 4, 4)")
    several = poses.reshape(-1, 4, 4)
    for number, pose in enumerate(several):
        which = name if poses.ndim == 2 else f"{name}[{number}]"
        turn = pose[:3, :3]
        if not np.isfinite(pose).all():
            raise InvalidInput(f"{which} has a number that is not finite")
        if np.abs(pose[3] - (0, 0, 0, 1)).max() > _RIGID:
            raise InvalidInput(
                f"{which} ends with the row {pose[3].tolist()}; allowed is 0, 0, 0, 1"
            )
        if (off := np.abs(turn.T @ turn - np.eye(3)).max()) > _RIGID:
            raise InvalidInput(
                f"{which} is not rigid: the products of its columns are off 0 and 1 by {off:.3g}; "
                "allowed is a rotation with a translation"
            )
        if np.linalg.det(turn) < 0:
            raise InvalidInput(f"{which} is a reflection; allowed is a rotation with a translation")
    return several


def nearest_poses(poses: Matrices, to: Matrices, turns: Matrices, axes: Sequence[Axis]) -> Matrices:
    """The pose @ turn of each pose by the least angle from those of ``to``. ``turns``: (k, 4, 4)
    about one centre, the identity first; ``axes``: the continuous ones.

    That angle has the cosine (trace - 1) / 2 of the rotation that is left. All equivalent poses have
    the centre in the same place, so that their translations do not tell them apart.
    """
    left = np.swapaxes(poses[:, :3, :3], 1, 2) @ to[:, :3, :3]  # that a turn should be nearest to
    if len(axes) > 1:  # of a ball, any turn: none is left
        centre = axes[0].point
        return poses @ _about(_nearest_rotations(left), centre)
    candidates = np.broadcast_to(turns, (len(left), *turns.shape))
    if axes:
        axis = axes[0]
        rest = left[:, None] @ np.swapaxes(turns[:, :3, :3], 1, 2)
        # Of a turn about the axis by t the trace has a part cosine cos t + sine sin t.
        cosine = np.trace(rest, axis1=2, axis2=3) - axis.direction @ rest @ axis.direction
        sine = np.einsum("ij,nkij->nk", _cross_matrix(axis.direction), rest)
        angles = np.arctan2(sine, cosine)
        candidates = _about(_turns(axis.direction, angles), axis.point) @ candidates
    traces = np.einsum("nij,nkij->nk", left, candidates[..., :3, :3])
    first = (traces >= traces.max(axis=1, keepdims=True) - _SAME).argmax(axis=1)
    return poses @ candidates[np.arange(len(poses)), first]


def extents(points: ArrayLike) -> dict[str, float]:
    """The bounding box of points (n, 3) and their diameter, the largest distance of two, by the names
    of the BOP toolkit's ``models_info.json``."""
    rows = np.asarray(points, dtype=np.float64)
    rows = rows[np.isfinite(rows).all(axis=1)]
    low, size = rows.min(axis=0), np.ptp(rows, axis=0)
    box = {f"min_{axis}": float(low[k]) for k, axis in enumerate("xyz")}
    box |= {f"size_{axis}": float(size[k]) for k, axis in enumerate("xyz")}
    return {"diameter": _diameter(rows), **box}


def _diameter(rows: NDArray[np.float64]) -> float:
    from_middle = np.linalg.norm(rows - (rows.min(axis=0) + np.ptp(rows, axis=0) / 2), axis=1)
    one = rows[from_middle.argmax()]
    longest = float(np.linalg.norm(rows - one, axis=1).max())
    # Nearer to the middle a point has no partner so far off.
    rows = rows[from_middle >= longest * (1 - 1e-12) - from_middle.max()]
    for row in np.array_split(rows, -(-len(rows) // 256)):
        far = np.linalg.norm(row[:, None] - rows, axis=2)
        longest = max(longest, float(far.max()))
    return longest


def stepped(turns: Matrices, axes: Sequence[Axis], step: float) -> Matrices:
    """(k, 4, 4): the turns, the identity first, and about continuous axes those by steps of at most
    so many degrees; of a ball, by Euler angles in steps of 30 at least."""
    if not (np.isfinite(step) and 0 < step <= 180):
        raise InvalidParameter(f"step is {step!r}; allowed is above 0 and at most 180 degrees")
    if not axes:
        return turns
    if len(axes) > 1:
        step = max(step, _CLUSTER)
    count = int(np.ceil(360 / step - _SAME))
    angles = 2 * np.pi / count * np.arange(count)
    about = [_about(_turns(axis.direction, angles), axis.point) for axis in axes[:2]]
    if len(axes) == 1:
        return (turns[:, None] @ about[0]).reshape(-1, 4, 4)
    z, half = about[0], about[1][: count // 2 + 1]
    return (z[:, None, None] @ half[:, None] @ z).reshape(-1, 4, 4)


_CLUSTER = 30.0  # degrees; FoundationPose takes poses by less for one


def isaac_axes(turns: Matrices, axes: Sequence[Axis]) -> tuple[list[str], int]:
    """What Isaac calls the rotations about x, y and z, such as "z_120" and "x_full", and how many are
    neither these nor products of them."""
    along = [_coordinate(axis.direction) for axis in axes]
    if None in along:
        return [], len(axes) + len(turns) - 1
    if axes:
        names = [f"{name}_full" for name in along]
        # Any line across the axis is as good as that of the half turn that is listed.
        across = "y" if along == ["x"] else "x"
        return names + [f"{across}_180"] * (len(turns) > 1 and len(axes) == 1), 0
    angles: dict[str, list[float]] = {"z": [0], "y": [0], "x": [0]}
    for turn in turns[1:, :3, :3]:
        direction, angle = _axis_angle(turn)
        if name := _coordinate(direction):
            angles[name].append(angle if direction["xyz".index(name)] > 0 else 360 - angle)
    about = [
        _turns(np.eye(3)["xyz".index(name)], np.radians(each)) for name, each in angles.items()
    ]
    products = [z @ y @ x for z in about[0] for y in about[1] for x in about[2]]
    left_out = sum(
        min(np.abs(product - turn).max() for product in products) > _ALONG
        for turn in turns[:, :3, :3]
    )
    return sorted(f"{name}_{each:.6g}" for name in angles for each in angles[name][1:]), left_out


_ALONG = np.radians(1)  # off x, y or z


def _axis_angle(turn: Matrices) -> tuple[NDArray[np.float64], float]:
    """The unit axis of a rotation, and its angle in degrees, 0 to 180."""
    values, vectors = np.linalg.eig(turn)
    axis = vectors[:, np.abs(values - 1).argmin()].real
    sine = np.einsum("ij,ij->", _cross_matrix(axis), turn) / 2
    angle = np.degrees(np.arctan2(sine, (np.trace(turn) - 1) / 2))
    return (axis, float(angle)) if angle >= 0 else (-axis, float(-angle))


def _coordinate(direction: NDArray[np.float64]) -> str | None:
    """ "x", "y" or "z" where a unit direction is along it, either way."""
    largest = int(np.abs(direction).argmax())
    return "xyz"[largest] if np.abs(direction[largest]) >= np.cos(_ALONG) else None


def _nearest_rotations(matrices: Matrices) -> Matrices:
    """Those of the poses may be rounded to single precision."""
    u, _, vt = np.linalg.svd(matrices)
    return u @ vt


def _turns(axis: NDArray[np.float64], angles: NDArray[np.floating[Any]]) -> Matrices:
    """(..., 3, 3) by Rodrigues' formula."""
    along, cross = np.outer(axis, axis), _cross_matrix(axis)
    cosine, sine = np.cos(angles)[..., None, None], np.sin(angles)[..., None, None]
    return along + cosine * (np.eye(3) - along) + sine * cross


def _cross_matrix(v: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _about(turns: Matrices, centre: NDArray[np.float64]) -> Matrices:
    """(..., 4, 4): the turns with the centre in its place."""
    motions = np.zeros((*turns.shape[:-2], 4, 4))
    motions[..., :3, :3] = turns
    motions[..., :3, 3] = centre - turns @ centre
    motions[..., 3, 3] = 1
    return motions
