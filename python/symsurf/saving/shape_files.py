"""Writing the shapes of operations and analyses, in the format of a suffix: one that keeps what the
file of the shape holds where that is of the same format, else one of points, faces and arrays."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import partial
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import InvalidInput, InvalidParameter
from ..reading import read
from ..reading.formats import format_of
from ..reading.location import leads_away
from ..results import AnalysisResult, Correspondences, OperationResult, Transferred
from ..results.operation_results import added_faces
from ..shapes import Shape
from ..shapes.shape import SourceFile
from .glb_format import shape_glb_bytes
from .json_format import json_bytes
from .ply_format import shape_ply_bytes
from .same_format import (
    OTHER_REWRITERS,
    REWRITERS,
    NewShape,
    Rewritten,
    lost_arrays,
    plain_content,
    shape_bytes,
)
from .table_format import csv_bytes, mirror_bytes, npy_bytes
from .vtp_format import shape_vtp_bytes
from .whole_files import write_whole

_SINGLE = 1e-6  # of the largest coordinate: what binary STL rounds to
_PLAIN = (".stl", ".xyz", ".off")  # without normals and colours they hold nothing beside

_Arrays = Mapping[str, NDArray[Any]]


def _bare_bytes(suffix: str, shape: Shape, _arrays: _Arrays, _face_arrays: _Arrays) -> bytes:
    if suffix == ".stl" and shape.faces is None:
        raise InvalidInput("STL holds triangles, and the shape has none; allowed is another format")
    return shape_bytes(shape, suffix)


SHAPES: dict[str, Callable[[Shape, _Arrays, _Arrays], bytes]] = {
    ".ply": shape_ply_bytes,
    ".vtp": shape_vtp_bytes,
    ".glb": shape_glb_bytes,
    **{suffix: partial(_bare_bytes, suffix) for suffix in (".obj", ".off", ".stl")},
}
_ARRAYS = {".csv": csv_bytes, ".npy": npy_bytes}
_HOLD_ARRAYS = (".ply", ".vtp", ".glb")  # of points; the first two those of faces, too


def formats_of(kind: type[OperationResult | AnalysisResult]) -> list[str]:
    """The suffixes that any result of the class can be saved with, whatever it was made of."""
    own = [".mirror"] if issubclass(kind, Correspondences) else []
    return [*SHAPES, *_ARRAYS, ".json", *own]


def require_format(path: str | os.PathLike[str], formats: Iterable[str]) -> None:
    """Raises InvalidParameter for another suffix."""
    if Path(path).suffix.lower() not in formats:
        allowed = ", ".join(formats)
        raise InvalidParameter(f"path is {os.fspath(path)!r}; allowed are the suffixes {allowed}")


def makes_shape(operation: _core.Operation) -> bool:
    """Whether there is more than arrays of the points that are given."""
    return operation.moves_points or operation.adds_points or operation.carries_values


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
        if f".{format_name}" not in SHAPES:
            allowed = ", ".join(["input", *(name[1:] for name in SHAPES)])
            raise InvalidParameter(f"format is {format_name}; allowed are {allowed}")
        return f".{format_name}"
    suffix = file.suffix if input_format is None else f".{input_format}"
    is_kept = suffix.lower() in REWRITERS and makes_shape(described)
    return suffix if is_kept or suffix.lower() == ".ply" else ".ply"


def save_shape(result: OperationResult | AnalysisResult, path: str | os.PathLike[str]) -> list[str]:
    """Writes the result whole or not at all; gives what of its file and its arrays is not in what was
    written, a sentence each."""
    path = Path(path)
    suffix = path.suffix.lower()
    given = result.given if isinstance(result, OperationResult) else result.shape
    if given.source is not None and _is_rewritten(result, given.source, suffix):
        rewritten = _rewritten(result, given, given.source, path)
        write_whole(path, rewritten.content)
        return _lost_polygons(result) + rewritten.lost
    require_format(path, formats_of(type(result)))
    if suffix not in SHAPES:
        write_whole(path, _table_bytes(result, suffix))
        return []
    if given.source is not None and _lacks_values(result):
        raise InvalidInput(
            f"what the points of a {given.source.suffix} file have cannot be carried over in {suffix}; "
            f"allowed are {', '.join(REWRITERS)}, each written in its own format"
        )
    face_arrays = result.face_arrays if isinstance(result, OperationResult) else {}
    write_whole(path, SHAPES[suffix](result.shape, result.arrays, face_arrays))
    names = [] if suffix in _HOLD_ARRAYS else list(result.arrays)
    names += [] if suffix in _HOLD_ARRAYS[:2] else face_arrays
    lost = [lost_arrays(suffix[1:].upper(), names)] if names else []
    return _lost_polygons(result) + _left_out(given, suffix) + lost


def _is_rewritten(
    result: OperationResult | AnalysisResult, source: SourceFile, suffix: str
) -> bool:
    """Whether the file is kept but for what changes. The table of what gives nothing but arrays is
    that of these alone."""
    if suffix != source.suffix or suffix not in REWRITERS:
        return False
    return suffix not in _ARRAYS or (
        isinstance(result, OperationResult) and makes_shape(_core.operations()[result.operation])
    )


def _lacks_values(result: OperationResult | AnalysisResult) -> bool:
    """Whether all that it has to give is what the file's points have."""
    return isinstance(result, Transferred) and result.values is None


def _table_bytes(result: Any, suffix: str) -> bytes:
    if suffix == ".json":
        return json_bytes(result)
    if suffix == ".mirror":
        return mirror_bytes(result)
    if isinstance(result, AnalysisResult) and not result.arrays:
        raise InvalidParameter(
            f"the suffix is {suffix}; {result.analysis} gives no arrays: allowed are the other suffixes"
        )
    return _ARRAYS[suffix](result.arrays)


def _rewritten(
    result: OperationResult | AnalysisResult, given: Shape, source: SourceFile, path: Path
) -> Rewritten:
    if isinstance(result, OperationResult):
        new = _new_shape(result, given, partial(_reached, source, path))
    else:
        faces = _faces(given)
        rows = np.arange(len(given.points))
        new = NewShape(given.points, faces, len(faces), rows, moved=False, arrays=result.arrays)
    rewritten = None
    with suppress(OSError):  # it is gone, or may not be read any more
        content = source.path.read_bytes() if source.content is None else source.content
        rewritten = _kept(content, source.suffix, new)
    if rewritten is None and _lacks_values(result):
        raise InvalidInput(
            f"{source.path} is written in a way that values cannot be carried over in"
        )
    return rewritten or _anew(given, source.suffix, new)


def _faces(shape: Shape) -> NDArray[np.int64]:
    return np.empty((0, 3), np.int64) if shape.faces is None else shape.faces


def _new_shape(
    result: OperationResult, given: Shape, reached: Callable[[str], str | None]
) -> NewShape:
    matrix = result.statistics.get("matrix")
    frame = result.parameters.get("frame")
    carries = _core.operations()[result.operation].carries_values
    count = len(given.points)
    faces = _faces(result.shape)
    is_moved = not np.array_equal(result.shape.points[:count], given.points, equal_nan=True)
    return NewShape(
        points=result.shape.points,
        faces=faces,
        old_faces=0 if result.is_other else len(faces) - added_faces(result.statistics),
        sources=np.arange(count) if carries else result.sources,
        moved=result.is_other or is_moved,
        turn=None if matrix is None else np.asarray(matrix)[:3, :3],
        space=frame.upper().encode() if frame in ("ras", "lps") else None,
        arrays=result.arrays,
        face_arrays=result.face_arrays,
        is_other=result.is_other,
        given_faces=given.faces,
        face_sources=result.face_sources,
        parents=result.parents,
        shares=result.shares,
        carried=None if result.parents is None else result.carried,
        directed=result.carried if result.turns else None,
        kinds=result.kinds,
        polygons=result.shape.polygons,
        reached=reached,
    )


def _lost_polygons(result: OperationResult | AnalysisResult) -> list[str]:
    """What to say of polygons that are written as triangles."""
    if not isinstance(result, OperationResult) or result.given.polygons is None:
        return []
    given, made = result.given.polygons, result.shape.polygons
    parts = np.bincount(given)[given][result.face_sources] > 1
    kept = np.bincount(made)[made] > 1 if made is not None else np.zeros(len(parts), bool)
    count = int(np.count_nonzero(parts & ~kept))
    return [f"{count} triangles are written of what were larger polygons"] if count else []


def _left_out(given: Shape, suffix: str) -> list[str]:
    """What to say of a file of which points and faces alone are kept."""
    described = given.source and format_of(given.source.suffix)
    is_plain = given.normals is None and given.colours is None
    if not described or described.is_image or (is_plain and described.suffix in _PLAIN):
        return []
    name = suffix[1:].upper()
    kept = (
        f"converted from {described.name} to {name}: points and faces are kept; normals, colours, "
    )
    return [kept + "textures, materials and other attributes are not"]


def _reached(source: SourceFile, output: Path, name: str) -> str | None:
    """The name of a file beside the source as it is seen from the output."""
    file = source.path.parent / name
    if source.content is not None or leads_away(file, source.path):
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
    if suffix == ".glb":
        faces = new.faces if len(new.faces) else None
        content = shape_glb_bytes(Shape(new.points, faces), new.arrays)
        return Rewritten(content, ["nothing of the file is kept but points and faces"])
    if new.is_other:
        shape = Shape(new.points, new.faces if len(new.faces) else None, polygons=new.polygons)
        rows = np.arange(len(new.points))
        new = replace(
            new,
            old_faces=len(new.faces),
            sources=rows,
            moved=False,
            is_other=False,
            carried=None,
            directed=None,
        )
    rewritten = REWRITERS[suffix](plain_content(shape, suffix, new.face_arrays), new)
    return rewritten._replace(
        lost=["nothing of the file is kept but points and faces", *rewritten.lost]
    )
