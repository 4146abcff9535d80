"""Results as VTK poly data (XML): surface points as vertices, the mirror as triangles.

Point arrays: Residual, and MirrorPoint and MirrorPartner, the indices of the pair; on the mirror's
own vertices NaN and -1. Field arrays: Kind, Score and the numbers of the mirror.
"""

from __future__ import annotations

import base64
from xml.sax.saxutils import escape, quoteattr

import numpy as np
from numpy.typing import NDArray

from ..mirror_mesh import mirror_mesh
from ..result import Result

_TYPES = {"f": "Float64", "i": "Int64"}


def vtp_bytes(result: Result) -> bytes:
    vertices, triangles = mirror_mesh(result, result.points)
    count, extra = len(result.surface_points), len(vertices)
    none = np.full(extra, -1)
    points = np.concatenate([result.surface_points, vertices])
    residuals = np.concatenate([result.residuals, np.full(extra, np.nan)])
    pairs = [np.concatenate([column, none]) for column in result.pairs.T]
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<PolyData>",
        "<FieldData>",
        *_field_data(result),
        "</FieldData>",
        (
            f'<Piece NumberOfPoints="{len(points)}" NumberOfVerts="{count}"'
            f' NumberOfPolys="{len(triangles)}">'
        ),
        '<PointData Scalars="Residual">',
        _array("Residual", residuals),
        _array("MirrorPoint", pairs[0]),
        _array("MirrorPartner", pairs[1]),
        "</PointData>",
        f"<Points>{_array('Points', points)}</Points>",
        f"<Verts>{_cells(np.arange(count).reshape(-1, 1))}</Verts>",
        f"<Polys>{_cells(triangles + count)}</Polys>",
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    return ("\n".join(lines) + "\n").encode()


def _field_data(result: Result) -> list[str]:
    fields = [_array("Score", np.array([result.score]), tuples=True)]
    if result.mirror is not None:
        codes = " ".join(str(byte) for byte in result.mirror.kind.encode() + b"\0")
        fields.append(
            '<Array type="String" Name="Kind" NumberOfTuples="1" format="ascii">'
            f"{escape(codes)}</Array>"
        )
        for name, value in result.mirror.numbers.items():
            if isinstance(value, (float, np.ndarray)):
                fields.append(_array(name.capitalize(), np.atleast_2d(value), tuples=True))
    return fields


def _cells(corners: NDArray[np.int64]) -> str:
    count, size = corners.shape
    ends = np.arange(1, count + 1) * size
    return _array("connectivity", corners.ravel()) + _array("offsets", ends)


def _array(name: str, values: NDArray[np.generic], tuples: bool = False) -> str:
    kind = values.dtype.kind
    components = values.shape[1] if values.ndim == 2 else 1
    data = np.ascontiguousarray(values, f"<{kind}8").tobytes()
    encoded = base64.b64encode(np.array([len(data)], "<u8").tobytes() + data).decode()
    length = f' NumberOfTuples="{len(values)}"' if tuples else ""
    return (
        f'<DataArray type="{_TYPES[kind]}" Name={quoteattr(name)}'
        f' NumberOfComponents="{components}"{length} format="binary">{encoded}</DataArray>'
    )
