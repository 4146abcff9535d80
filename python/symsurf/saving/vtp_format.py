"""Results as VTK poly data (XML): surface points as vertices, the mirror as triangles.

Point arrays: Residual, and MirrorPoint and MirrorPartner, the indices of the pair; on the mirror's
own vertices NaN and -1. Field arrays: Kind, Score and the numbers of the mirror.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from html import escape  # xml.sax.saxutils would import urllib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results import Result
from ..results.mirror_mesh import mirror_mesh
from ..shapes import Shape
from ..shapes.polygons import corners_of

_TYPES = {"f": "Float64", "i": "Int64"}


def vtp_bytes(result: Result) -> bytes:
    vertices, triangles = mirror_mesh(result, result.points)
    count, extra = len(result.surface_points), len(vertices)
    none = np.full(extra, -1)
    points = np.concatenate([result.surface_points, vertices])
    residuals = np.concatenate([result.residuals, np.full(extra, np.nan)])
    pairs = [np.concatenate([column, none]) for column in result.pairs.T]
    return poly_data(
        points,
        np.arange(count).reshape(-1, 1),
        triangles + count,
        {"Residual": residuals, "MirrorPoint": pairs[0], "MirrorPartner": pairs[1]},
        _field_data(result),
    )


def shape_vtp_bytes(
    shape: Shape,
    arrays: Mapping[str, NDArray[Any]],
    face_arrays: Mapping[str, NDArray[Any]] | None = None,
) -> bytes:
    """A shape with arrays of its points and faces; a bare cloud as vertices."""
    none = np.empty((0, 3), np.int64)
    is_cloud = shape.faces is None or not len(shape.faces)
    vertices = np.arange(len(shape.points)).reshape(-1, 1) if is_cloud else none[:, :1]
    faces: Any = none if shape.faces is None else shape.faces
    of_faces = {} if is_cloud else _numbers(face_arrays or {})
    if shape.polygons is not None:
        rows, faces = zip(*corners_of(faces, shape.polygons))
        of_faces = {name: values[list(rows)] for name, values in of_faces.items()}
    return poly_data(shape.points, vertices, faces, _numbers(arrays), _space(shape), of_faces)


def _numbers(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    return {
        name: values.astype(np.int64) if values.dtype.kind == "b" else values
        for name, values in arrays.items()
    }


def poly_data(
    points: NDArray[np.float64],
    vertices: NDArray[np.int64],
    polygons: Sequence[Sequence[int]] | NDArray[np.int64],
    arrays: Mapping[str, NDArray[Any]],
    fields: Sequence[str] = (),
    cell_arrays: Mapping[str, NDArray[Any]] | None = None,
) -> bytes:
    """The file; the first array is the active scalars."""
    active = f' Scalars="{escape(next(iter(arrays)))}"' if arrays else ""
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<PolyData>",
        "<FieldData>",
        *fields,
        "</FieldData>",
        (
            f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="{len(vertices)}"'
            f' NumberOfPolys="{len(polygons)}">'
        ),
        f"<PointData{active}>",
        *(_array(name, values) for name, values in arrays.items()),
        "</PointData>",
        "<CellData>",
        *(_array(name, values) for name, values in (cell_arrays or {}).items()),
        "</CellData>",
        f"<Points>{_array('Points', points)}</Points>",
        f"<Verts>{_cells(vertices)}</Verts>",
        f"<Polys>{_cells(polygons)}</Polys>",
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    return ("\n".join(lines) + "\n").encode()


def _field_data(result: Result) -> list[str]:
    fields = [*_space(result), _array("Score", np.array([result.score]), tuples=True)]
    if result.mirror is not None:
        fields.append(_text("Kind", result.mirror.kind))
        for name, value in result.mirror.numbers.items():
            if isinstance(value, (float, np.ndarray)):
                fields.append(_array(name.capitalize(), np.atleast_2d(value), tuples=True))
    return fields


def _space(of: Shape | Result) -> list[str]:
    return [_text("SPACE", of.space)] if of.space else []


def _text(name: str, text: str) -> str:
    codes = " ".join(str(byte) for byte in text.encode() + b"\0")
    return f'<Array type="String" Name="{name}" NumberOfTuples="1" format="ascii">{codes}</Array>'


def _cells(cells: Sequence[Sequence[int]] | NDArray[np.int64]) -> str:
    if isinstance(cells, np.ndarray):
        corners, ends = cells.ravel(), np.arange(1, len(cells) + 1) * cells.shape[1]
    else:
        corners = np.array([corner for cell in cells for corner in cell], np.int64)
        ends = np.cumsum([len(cell) for cell in cells], dtype=np.int64)
    return _array("connectivity", corners) + _array("offsets", ends)


def _array(name: str, values: NDArray[np.generic], tuples: bool = False) -> str:
    kind = values.dtype.kind
    components = values.shape[1] if values.ndim == 2 else 1
    data = np.ascontiguousarray(values, f"<{kind}8").tobytes()
    encoded = base64.b64encode(np.array([len(data)], "<u8").tobytes() + data).decode()
    length = f' NumberOfTuples="{len(values)}"' if tuples else ""
    return (
        f'<DataArray type="{_TYPES[kind]}" Name="{escape(name)}"'
        f' NumberOfComponents="{components}"{length} format="binary">{encoded}</DataArray>'
    )
