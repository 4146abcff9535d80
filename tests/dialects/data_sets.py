"""VTK's data sets, legacy and XML."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from . import FACES, POINTS


def vtk(cells: str = "", head: str = "", kind: str = "POLYDATA", real: str = "float") -> bytes:
    points = " ".join(f"{x:g}" for x in POINTS.ravel())
    triangles = "\n".join(f"3 {a} {b} {c}" for a, b, c in FACES)
    polygons = cells or f"POLYGONS {len(FACES)} {4 * len(FACES)}\n{triangles}\n"
    return (
        f"# vtk DataFile Version 3.0\n{head or 'made'}\nASCII\nDATASET {kind}\n"
        f"POINTS {len(POINTS)} {real}\n{points}\n{polygons}"
    ).encode()


def _saved(suffix: str, change: Callable[[Any, Any], Any]) -> tuple[str, Callable[[Path], None]]:
    def write(path: Path) -> None:
        import pyvista
        from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
        from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

        data = pyvista.PolyData.from_regular_faces(POINTS, FACES)
        if suffix == ".vtu" or change is _as_grid:
            data = data.cast_to_unstructured_grid()
        writers = {
            ".vtp": vtkXMLPolyDataWriter,
            ".vtu": vtkXMLUnstructuredGridWriter,
            ".vtk": vtkUnstructuredGridWriter if change is _as_grid else vtkPolyDataWriter,
        }
        writer = writers[suffix]()
        change(writer, data)
        writer.SetInputData(data)
        writer.SetFileName(str(path))
        writer.Write()

    return suffix, write


def _as_grid(writer: Any, data: Any) -> None:
    writer.SetFileTypeToBinary()


def _colours(writer: Any, data: Any) -> None:
    data["colours"] = np.zeros((6, 3), np.uint8)
    data.point_data.active_normals = np.tile((0.0, 0, 1), (6, 1))


_TRIANGLES = [f"3 {a} {b} {c}" for a, b, c in FACES[2:]]
VTK: dict[str, Any] = {
    "text": vtk(),
    "text in doubles": vtk(real="double"),
    "a title": vtk(head="3D Slicer output. SPACE=RAS"),
    "of Windows": vtk().replace(b"\n", b"\r\n"),
    "a quadrangle": vtk("POLYGONS 6 25\n4 0 3 2 1\n" + "\n".join(_TRIANGLES) + "\n"),
    "a strip": vtk(
        "POLYGONS 5 20\n" + "\n".join(_TRIANGLES) + "\nTRIANGLE_STRIPS 1 5\n4 3 2 0 1\n"
    ),
    "an unstructured grid": vtk(
        "CELLS 7 28\n"
        + "\n".join(f"3 {a} {b} {c}" for a, b, c in FACES)
        + "\nCELL_TYPES 7\n"
        + "5 " * 7
        + "\n",
        kind="UNSTRUCTURED_GRID",
    ),
    "vertices": vtk("VERTICES 1 7\n6 0 1 2 3 4 5\n"),
    "binary": _saved(".vtk", lambda writer, data: writer.SetFileTypeToBinary()),
    "binary, as of VTK 4": _saved(
        ".vtk", lambda writer, data: [writer.SetFileVersion(42), writer.SetFileTypeToBinary()]
    ),
    "text, as of VTK 4": _saved(".vtk", lambda writer, data: writer.SetFileVersion(42)),
    "a binary grid": _saved(".vtk", _as_grid),
    "XML": _saved(".vtp", lambda writer, data: None),
    "XML in text": _saved(".vtp", lambda writer, data: writer.SetDataModeToAscii()),
    "XML in Base64": _saved(".vtp", lambda writer, data: writer.SetDataModeToBinary()),
    "XML in appended Base64": _saved(".vtp", lambda writer, data: writer.EncodeAppendedDataOn()),
    "XML, raw": _saved(".vtp", lambda writer, data: writer.EncodeAppendedDataOff()),
    "XML, not packed": _saved(".vtp", lambda writer, data: writer.SetCompressorTypeToNone()),
    "XML, LZ4": _saved(".vtp", lambda writer, data: writer.SetCompressorTypeToLZ4()),
    "XML, LZMA": _saved(".vtp", lambda writer, data: writer.SetCompressorTypeToLZMA()),
    "XML, big": _saved(".vtp", lambda writer, data: writer.SetByteOrderToBigEndian()),
    "XML, long heads": _saved(".vtp", lambda writer, data: writer.SetHeaderTypeToUInt64()),
    "XML with colours and normals": _saved(".vtp", _colours),
    "XML of a grid": _saved(".vtu", lambda writer, data: None),
    "XML of a grid in text": _saved(".vtu", lambda writer, data: writer.SetDataModeToAscii()),
}
_HUGE = 9_000_000_000
REFUSED_VTK = {
    vtk().replace(b"POINTS 6", b"POINTS %d" % _HUGE): "VTK",
    vtk(f"POLYGONS {_HUGE} {4 * _HUGE}\n3 0 1 2\n"): "VTK",
    vtk("CELLS 1 4\n3 0 1 2\nCELL_TYPES 900000000000\n5\n", kind="UNSTRUCTURED_GRID"): "VTK",
    vtk().replace(b"3 0 3 2", b"3 0 3 7"): "names point 7",
}


def xml(kind: str, sizes: str, inside: str = "") -> bytes:
    """A file of three numbers, whose head says what it likes."""
    points = '<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0</DataArray>'
    return (
        f'<VTKFile type="{kind}" version="1.0"><{kind}><Piece {sizes}><Points>{points}</Points>'
        f"{inside}</Piece></{kind}></VTKFile>"
    ).encode()


LYING: dict[str, bytes] = {
    "points.vtp": xml("PolyData", f'NumberOfPoints="{_HUGE}"'),
    "polygons.vtp": xml("PolyData", f'NumberOfPoints="1" NumberOfPolys="{_HUGE}"'),
    "verts.vtp": xml("PolyData", f'NumberOfPoints="1" NumberOfVerts="{_HUGE}"'),
    "cells.vtu": xml("UnstructuredGrid", f'NumberOfPoints="1" NumberOfCells="{_HUGE}"'),
    "points.vtu": xml("UnstructuredGrid", f'NumberOfPoints="{_HUGE}" NumberOfCells="1"'),
    "array.vtp": xml(
        "PolyData",
        'NumberOfPoints="1"',
        '<PointData><DataArray type="Float64" Name="a" NumberOfComponents="2000000000" '
        'format="ascii">1</DataArray></PointData>',
    ),
    "image.vti": b'<VTKFile type="ImageData" version="1.0"><ImageData WholeExtent="0 99999 0 99999 0 '
    b'99999" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 99999 0 99999 0 99999"><PointData '
    b'Scalars="a"><DataArray type="UInt8" Name="a" format="ascii">1</DataArray></PointData></Piece>'
    b"</ImageData></VTKFile>",
    "image.vtk": b"# vtk DataFile Version 3.0\na\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 99999 "
    b"99999 99999\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 999970000299999\nSCALARS a double\n"
    b"LOOKUP_TABLE default\n1\n",
}
