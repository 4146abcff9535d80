"""Writing what an operation has made of a file."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np

from .. import _core
from .._core import InvalidInput, InvalidParameter
from ..reading import read
from ..results import OperationResult
from ..shapes import Shape
from . import SHAPE_FORMATS, write_whole
from .same_format import OTHER_REWRITERS, REWRITERS, NewShape, Rewritten, plain_content

_SINGLE = 1e-6  # of the largest coordinate: what binary STL rounds to


def output_suffix(
    file: Path, operation: str, format_name: str = "input", input_format: str | None = None
) -> str:
    """The suffix of what the operation makes of the file.

    With the format "input" it is the file's own, and ``.ply`` where that cannot be rewritten, or
    cannot hold what the operation gives each point, and gives nothing else.
    """
    if operation not in _core.operations():
        return ".summary.json"
    if format_name != "input":
        if f".{format_name}" not in SHAPE_FORMATS:
            allowed = ", ".join(["input", *(name[1:] for name in SHAPE_FORMATS)])
            raise InvalidParameter(f"format is {format_name}; allowed are {allowed}")
        return f".{format_name}"
    described = _core.operations()[operation]
    has_shape = described.moves_points or described.adds_points or described.carries_values
    suffix = file.suffix if input_format is None else f".{input_format}"
    is_kept = suffix.lower() in REWRITERS and has_shape
    return suffix if is_kept or suffix.lower() == ".ply" else ".ply"


def save_shape(
    path: Path,
    result: OperationResult,
    shape: Shape,
    source: Path,
    suffix: str,
    content: bytes | None = None,
) -> list[str]:
    """Writes the result whole or not at all; gives what of the source it does not hold.

    Args:
        path: in the source's format whatever the source holds is kept; other suffixes are those of
            ``result.save``.
        shape: what was read from the source.
        suffix: of the format that the source was read in, such as ".ply" or ".ply.gz".
        content: of the source, where that is no file.
    """
    is_same = suffix in REWRITERS and suffix == path.suffix.lower()
    carries = _core.operations()[result.operation].carries_values
    if carries and not is_same:
        raise InvalidInput(
            f"what the points of a {suffix} file have cannot be carried over in {path.suffix}; allowed "
            f"are {', '.join(REWRITERS)}, each written in its own format"
        )
    if not is_same:
        result.save(path)
        return []
    matrix = result.statistics.get("matrix")
    frame = result.parameters.get("frame")
    faces = result.shape.faces
    new = NewShape(
        points=result.shape.points,
        faces=np.empty((0, 3), np.int64) if faces is None else faces,
        old_faces=0 if shape.faces is None or result.is_other else len(shape.faces),
        sources=np.arange(len(shape.points)) if carries else result.sources,
        moved=result.is_other
        or not np.array_equal(
            result.shape.points[: len(shape.points)], shape.points, equal_nan=True
        ),
        turn=None if matrix is None else np.asarray(matrix)[:3, :3],
        space=frame.upper().encode() if frame in ("ras", "lps") else None,
        arrays=result.arrays,
        face_arrays=result.face_arrays,
        is_other=result.is_other,
        given_faces=shape.faces,
        face_sources=result.face_sources,
        parents=result.parents,
        shares=result.shares,
        carried=None if result.parents is None else result.carried,
    )
    given = source.read_bytes() if content is None else content
    rewritten = _kept(given, suffix, new)
    if rewritten is None and carries:
        raise InvalidInput(f"{source} is written in a way that values cannot be carried over in")
    rewritten = rewritten or _anew(shape, suffix, new)
    write_whole(path, rewritten.content)
    return rewritten.lost


def _kept(content: bytes, suffix: str, new: NewShape) -> Rewritten | None:
    """The file with the new shape in it; None where that is written in another way than those that
    are kept, so that what was made would not be read as that shape."""
    rewriters = OTHER_REWRITERS if new.is_other else REWRITERS
    if suffix not in rewriters:
        return None
    try:
        rewritten = rewriters[suffix](content, new)
        made = read(BytesIO(rewritten.content), suffix[1:])
    except (InvalidInput, ValueError, LookupError):
        return None
    faces = np.empty((0, 3), np.int64) if made.faces is None else made.faces
    if made.points.shape != new.points.shape or faces.shape != new.faces.shape:
        return None
    finite = np.isfinite(new.points)
    if not np.array_equal(finite, np.isfinite(made.points)):
        return None
    wanted = new.points[finite]
    error = np.abs(made.points[finite] - wanted).max(initial=0)
    return rewritten if error <= _SINGLE * np.abs(wanted).max(initial=0) else None


def _anew(shape: Shape, suffix: str, new: NewShape) -> Rewritten:
    """A file of points and faces alone."""
    if new.is_other:
        shape = Shape(new.points, new.faces if len(new.faces) else None)
        rows = np.arange(len(new.points))
        new = replace(
            new, old_faces=len(new.faces), sources=rows, moved=False, is_other=False, carried=None
        )
    rewritten = REWRITERS[suffix](plain_content(shape, suffix, new.face_arrays), new)
    return rewritten._replace(
        lost=["nothing of the file is kept but points and faces", *rewritten.lost]
    )
