"""Writing what an operation has made of a file."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import replace
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np

from .. import _core
from .._core import InvalidInput, InvalidParameter
from ..reading import read
from ..reading.formats import format_of
from ..reading.location import leads_away
from ..results import OperationResult
from ..shapes import Shape
from . import BARE_FORMATS, makes_shape, shape_formats, write_whole
from .same_format import OTHER_REWRITERS, REWRITERS, NewShape, Rewritten, lost_arrays, plain_content

_BARE = (".stl", ".xyz", ".off")  # without normals and colours they hold nothing beside
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
    described = _core.operations()[operation]
    if format_name != "input":
        formats = shape_formats(described)
        if f".{format_name}" not in formats:
            allowed = ", ".join(["input", *(name[1:] for name in formats)])
            raise InvalidParameter(f"format is {format_name}; allowed are {allowed}")
        return f".{format_name}"
    suffix = file.suffix if input_format is None else f".{input_format}"
    is_kept = suffix.lower() in REWRITERS and makes_shape(described)
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
        return _lost_polygons(result) + _left_out(shape, suffix, path) + _lost_arrays(result, path)
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
        polygons=result.shape.polygons,
        reached=partial(_reached, source if content is None else None, path),
    )
    given = source.read_bytes() if content is None else content
    rewritten = _kept(given, suffix, new)
    if rewritten is None and carries:
        raise InvalidInput(f"{source} is written in a way that values cannot be carried over in")
    rewritten = rewritten or _anew(shape, suffix, new)
    write_whole(path, rewritten.content)
    return _lost_polygons(result) + rewritten.lost


def _lost_polygons(result: OperationResult) -> list[str]:
    """What to say of polygons that are written as triangles."""
    given, made = result.given.polygons, result.shape.polygons
    if given is None:
        return []
    parts = np.bincount(given)[given][result.face_sources] > 1
    kept = np.bincount(made)[made] > 1 if made is not None else np.zeros(len(parts), bool)
    count = int(np.count_nonzero(parts & ~kept))
    return [f"{count} triangles are written of what were larger polygons"] if count else []


def _left_out(shape: Shape, suffix: str, output: Path) -> list[str]:
    """What to say of a file of which points and faces alone are kept."""
    described = format_of(suffix)
    is_plain = shape.normals is None and shape.colours is None
    if described is None or described.is_image or (is_plain and described.suffix in _BARE):
        return []
    made = output.suffix[1:].upper()
    text = (
        f"{made} is written anew: of the {described.name} file points and faces are kept, none of "
    )
    return [text + "its normals, colours, textures, materials and other attributes"]


def _lost_arrays(result: OperationResult, output: Path) -> list[str]:
    names = [*result.arrays, *result.face_arrays]
    if not names or output.suffix.lower() not in BARE_FORMATS:
        return []
    return [lost_arrays(output.suffix[1:].upper(), names)]


def _reached(source: Path | None, output: Path, name: str) -> str | None:
    """The name of a file beside the source as it is seen from the output."""
    if source is None or leads_away(file := source.parent / name, source):
        return None
    try:
        if not file.is_file():
            return None
    except OSError:  # such as for a name that is too long for one
        return None
    with suppress(ValueError):  # they lie on two drives
        file = Path(os.path.relpath(file.resolve(), output.parent.resolve()))
    return file.as_posix()


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
        shape = Shape(new.points, new.faces if len(new.faces) else None, polygons=new.polygons)
        rows = np.arange(len(new.points))
        new = replace(
            new, old_faces=len(new.faces), sources=rows, moved=False, is_other=False, carried=None
        )
    rewritten = REWRITERS[suffix](plain_content(shape, suffix, new.face_arrays), new)
    return rewritten._replace(
        lost=["nothing of the file is kept but points and faces", *rewritten.lost]
    )
