"""The detection of mirrors."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import numpyTovtkDataArray
from vtkmodules.vtkCommonDataModel import vtkPolyData

from .._core import InvalidInput, Plane, methods
from ..base.input_warning import InputWarning
from ..detection import detect
from ..results import Result
from ..shapes.poly_data import faces_of, points_of, rows_of, vtk_points
from .algorithm import REFUSE_NONFINITE, SEED, THREADS, Algorithm, Property, selected
from .arrays import add_values, set_vertices, vtk_cells


class MirrorDetection(Algorithm):
    """Finds the mirror of a shape; ``vtkMirrorDetection`` in Python.

    Where it has polygons, samples of their surface find the mirror, unless UseFaces is off. Points
    that are not finite are left out, with a warning, and have no partners; with RefuseNonfinite they
    are an error.

    Output 0 "Shape": the input; point data MirrorPartner (index, -1 for none), MirrorResidual (NaN
    for none) and MirrorSide; field data Kind, Score and Verdict of the mirror, and MirrorResidualP99,
    which at most a hundredth of the residuals exceeds (NaN without any). Output 1 "Mirror": triangles
    over the footprint, of the candidates too with ShowCandidates; cell data Rank (0 the result, from
    1 the candidates) and Score; field data, of the result, Method, Kind, Score, the mirror's numbers
    and the method's statistics, and CandidateScores, of planes also CandidateNormals and
    CandidateOffsets, where there are candidates. Output 2 "Surface Points": a vertex in the middle of
    each pair, at most half its residual off the mirror (``perpendicular``, ``quadric`` and
    ``fixed_direction`` project it onto that); point data Residual.

    Every parameter of every method is a property, a keyword of the constructor, and has its setter
    and getter: ``plane_pair_distance`` and ``SetPlanePairDistance`` for ``pair_distance`` of
    ``plane``. Other attributes cannot be set. Points are read in place when they are doubles. Bad
    input and values out of range are errors of the filter; they leave the outputs empty.
    """

    SHAPE, MIRROR, SURFACE_POINTS = range(3)
    _output_count = 3
    _properties = selected(
        "method",
        "How the mirror is sought.",
        methods(),
        {
            "use_normals": Property(False, "Whether the input's point normals are used, as lines."),
            "use_faces": Property(
                True,
                "Whether samples of the input's polygons find the mirror, not its points alone.",
            ),
            "refuse_nonfinite": REFUSE_NONFINITE,
            "show_candidates": Property(
                False, "Whether the output Mirror has the triangles of the candidates too."
            ),
            "seed": SEED,
            "number_of_threads": THREADS,
        },
    )

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        (source,) = inputs
        shape, mirror, surface_points = outputs
        result = self._detected(source)
        _set_mirror_meshes(mirror, result, self._options["show_candidates"])
        _set_mirror_fields(mirror, result)
        _set_surface_points(surface_points, result)
        shape.ShallowCopy(source)
        _set_shape(shape, result)

    def _detected(self, source: vtkPolyData) -> Result:
        options = self._options
        normals = source.GetPointData().GetNormals() if options["use_normals"] else None
        if options["use_normals"] and not normals and source.GetNumberOfPoints():
            raise InvalidInput(
                "UseNormals is on, but the input has no point normals; compute them first, or do "
                "without"
            )
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)  # said below as VTK says it
            result = detect(
                points_of(source),
                options["method"],
                faces=faces_of(source).corners if options["use_faces"] else None,
                normals=normals and rows_of(normals),
                nonfinite="refuse" if options["refuse_nonfinite"] else "skip",
                seed=options["seed"],
                threads=options["number_of_threads"],
                progress=self._progress,
                **self._chosen("method", methods()),
            )
        self._warn_of(result.statistics, "; they have no partners")
        return result


def _set_mirror_meshes(output: vtkPolyData, result: Result, with_candidates: bool) -> None:
    ranked = [result, *(result.candidates if with_candidates else [])]
    drawn = [
        (rank, each.score, each.mirror)
        for rank, each in enumerate(ranked)
        if each.mirror is not None
    ]
    if not drawn:
        return
    vertices, triangles = zip(*(mirror.mesh() for *_, mirror in drawn))
    first_vertices = np.cumsum([0, *map(len, vertices[:-1])])
    corners = [rows + first for rows, first in zip(triangles, first_vertices)]
    counts = [len(rows) for rows in triangles]
    output.SetPoints(vtk_points(np.vstack(vertices)))
    output.SetPolys(vtk_cells(np.vstack(corners)))
    ranks = np.repeat(np.array([rank for rank, *_ in drawn], np.int32), counts)
    scores = np.repeat([score for _, score, _ in drawn], counts)
    output.GetCellData().AddArray(numpyTovtkDataArray(ranks, "Rank"))
    output.GetCellData().AddArray(numpyTovtkDataArray(scores, "Score"))


def _set_mirror_fields(output: vtkPolyData, result: Result) -> None:
    values = result.statistics | {"method": result.method, "score": result.score}
    values |= _candidate_values(result.candidates)
    if result.mirror is not None:
        values |= {"kind": result.mirror.kind} | result.mirror.numbers
    add_values(output.GetFieldData(), values)


def _candidate_values(candidates: list[Result]) -> dict[str, Any]:
    """By name, one row per candidate."""
    if not candidates:
        return {}
    values = {"candidate_scores": np.array([[candidate.score] for candidate in candidates])}
    planes = [each.mirror for each in candidates if isinstance(each.mirror, Plane)]
    if len(planes) == len(candidates):
        values["candidate_normals"] = np.array([plane.normal for plane in planes])
        values["candidate_offsets"] = np.array([[plane.offset] for plane in planes])
    return values


def _set_surface_points(output: vtkPolyData, result: Result) -> None:
    set_vertices(output, result.surface_points)
    output.GetPointData().SetScalars(numpyTovtkDataArray(result.residuals, "Residual"))


def _set_shape(output: vtkPolyData, result: Result) -> None:
    count = output.GetNumberOfPoints()
    partners, residuals = np.full(count, -1, np.int64), np.full(count, np.nan)
    partners[result.pairs[:, 0]] = result.pairs[:, 1]
    residuals[result.pairs[:, 0]] = result.residuals
    sides = np.zeros(count, np.int8)
    if result.mirror is not None:
        points = points_of(output)
        distances = result.mirror.signed_distance(points)
        distances[~np.isfinite(points).all(axis=1)] = np.nan
        sides = np.nan_to_num(np.sign(distances)).astype(np.int8)
    data = output.GetPointData()
    data.AddArray(numpyTovtkDataArray(partners, "MirrorPartner"))
    data.AddArray(numpyTovtkDataArray(sides, "MirrorSide"))
    data.SetScalars(numpyTovtkDataArray(residuals, "MirrorResidual"))
    some = len(result.residuals) > 0
    p99 = float(np.quantile(result.residuals, 0.99, method="higher")) if some else np.nan
    kind = "none" if result.mirror is None else result.mirror.kind
    values = {"kind": kind, "score": result.score, "verdict": result.verdict}
    add_values(output.GetFieldData(), values | {"mirror_residual_p99": p99})
