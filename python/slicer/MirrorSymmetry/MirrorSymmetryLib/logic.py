"""From a model or a segmentation to its mirror, and the nodes that show it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import slicer

from . import nodes
from .surfaces import world_surface

if TYPE_CHECKING:
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    import symsurf

DEFAULT_METHOD = "plane"


@dataclass
class Outputs:
    """The nodes to fill in; None: not asked for."""

    plane: slicer.vtkMRMLMarkupsPlaneNode | None = None
    """The mirror plane; of a mirror that bends the plane nearest to it."""
    transform: slicer.vtkMRMLLinearTransformNode | None = None
    """From world coordinates to those where the mirror is R = 0."""
    mirror: slicer.vtkMRMLModelNode | None = None
    """The mirror as a surface, of any kind."""
    asymmetry: slicer.vtkMRMLModelNode | None = None
    """The shape in world coordinates, coloured by its signed asymmetry."""
    landmarks: slicer.vtkMRMLMarkupsFiducialNode | None = None
    """Where the other side says that each landmark should be."""
    landmark_table: slicer.vtkMRMLTableNode | None = None
    """Which landmark mirrors which, and how far apart they are over the mirror."""
    symmetries: slicer.vtkMRMLTableNode | None = None
    """All mirror planes and rotation axes of the shape, in world coordinates."""
    table: slicer.vtkMRMLTableNode | None = None
    """The figures, a row a shape: score, verdict, statistics of the asymmetry, the group."""


class SymmetryLogic:
    """Finds the mirror of a shape and fills nodes in; symsurf does the rest."""

    def process(
        self,
        shape: slicer.vtkMRMLNode,
        outputs: Outputs,
        *,
        segment: str = "",
        landmarks: slicer.vtkMRMLMarkupsFiducialNode | None = None,
        method: str = DEFAULT_METHOD,
        parameters: Mapping[str, Any] | None = None,
        use_faces: bool = True,
        progress: Callable[[float], bool | None] | None = None,
    ) -> symsurf.Result:
        """Finds the mirror and fills in the outputs that are asked for.

        Args:
            shape: a model or a segmentation; its parent transform counts.
            outputs: the nodes to fill in.
            segment: of a segmentation; see ``world_surface``.
            landmarks: to pair over the mirror, by their labels where these name sides.
            method: one of ``symsurf.methods()``.
            parameters: of the method, by name.
            use_faces: False: the vertices alone find the mirror, sooner; for surfaces whose vertices
                lie evenly, as those of scans do.
            progress: called with the fraction done of the search; returning False cancels.

        Raises:
            ValueError: no shape, landmarks asked for and none given; what ``symsurf.detect`` raises;
                no mirror is found.
        """
        surface = world_surface(shape, segment)
        options = {"use_faces": use_faces, "progress": progress, **(parameters or {})}
        groups = {}
        if outputs.symmetries is not None:
            groups["group"] = self._find_symmetries(surface, outputs.symmetries, progress)
        result = self._detected(surface, method, options)
        if result.mirror is None:
            raise ValueError(f"{method} finds no mirror in {shape.GetName()}: {result.reason}")
        figures = {"verdict": result.verdict, "score": result.score, **groups}
        if outputs.asymmetry is not None or outputs.table is not None:
            figures |= self._asymmetry(surface, result, outputs.asymmetry)
        self._set_mirror(surface, result, outputs)
        if outputs.table is not None:
            nodes.set_row(outputs.table, shape.GetName(), figures)
        if outputs.landmarks is not None or outputs.landmark_table is not None:
            self._pair_landmarks(landmarks, result, outputs)
        return result

    def _detected(
        self, surface: vtkPolyData, method: str, options: Mapping[str, Any]
    ) -> symsurf.Result:
        """Without the pairs of vertices, which no output shows."""
        import symsurf  # installed when it is first asked for

        known = symsurf.methods().get(method)
        has_pairs = known is not None and any(each.name == "pairs" for each in known.parameters)
        return symsurf.detect(surface, method, **({"pairs": False} if has_pairs else {}) | options)

    def _find_symmetries(
        self,
        surface: vtkPolyData,
        table: slicer.vtkMRMLTableNode,
        progress: Callable[[float], bool | None] | None,
    ) -> str:
        """The group, whose planes and axes the table gets."""
        import symsurf

        found = symsurf.symmetries(surface, progress=progress)
        nodes.set_table(table, _element_columns(found))
        return found.group

    def _set_mirror(self, surface: vtkPolyData, result: symsurf.Result, outputs: Outputs) -> None:
        import symsurf

        plane = result.mirror
        if outputs.plane is not None:
            if plane.kind != "plane":
                plane = symsurf.straight_mirror(result)
            nodes.set_plane(outputs.plane, plane, result.points)
        if outputs.mirror is not None:
            nodes.set_mesh(outputs.mirror, *result.mirror.mesh())
        if outputs.transform is not None:
            nodes.set_matrix(outputs.transform, symsurf.align(surface, result, axis="x").matrix)

    def _asymmetry(
        self, surface: vtkPolyData, result: symsurf.Result, model: slicer.vtkMRMLModelNode | None
    ) -> dict[str, float]:
        import symsurf

        found = symsurf.asymmetry(surface, result)
        if model is not None:
            nodes.set_coloured_model(model, found.like(surface), "signed", _limit(found.statistics))
        return found.statistics

    def _pair_landmarks(
        self,
        landmarks: slicer.vtkMRMLMarkupsFiducialNode | None,
        result: symsurf.Result,
        outputs: Outputs,
    ) -> None:
        import symsurf

        if landmarks is None:
            raise ValueError("pairs of landmarks are asked for, but no landmarks are chosen")
        points, names = nodes.points_of(landmarks)
        paired = symsurf.landmark_pairs(points, result, names)
        pairs = np.vstack([paired.pairs, np.column_stack(2 * [paired.midline])])
        images = result.mirror.reflect(points)
        apart = np.linalg.norm(images[pairs[:, 1]] - points[pairs[:, 0]], axis=1)
        if outputs.landmark_table is not None:
            nodes.set_table(outputs.landmark_table, _pair_columns(pairs, apart, paired.odd, names))
        if outputs.landmarks is not None:
            both = np.vstack([paired.pairs, paired.pairs[:, ::-1], pairs[len(paired.pairs) :]])
            labels = [names[own] for own in both[:, 0]]
            sources = [f"image of {names[partner]}" for partner in both[:, 1]]
            nodes.set_points(outputs.landmarks, images[both[:, 1]], labels, sources)


def _limit(statistics: Mapping[str, float]) -> float:
    """What the colours end at, mm: a few outliers do not take them all, unless all else is symmetric
    to rounding."""
    rounding = 1e-9 * statistics["diagonal"]
    limit = statistics["p99"] if statistics["p99"] > rounding else statistics["maximum"]
    return max(limit, rounding)


def _element_columns(found: symsurf.Symmetries) -> dict[str, list[Any]]:
    """A row a plane, by its normal and a point on it, then one an axis."""
    planes, axes = found.planes, found.axes
    directions = [plane.normal for plane in planes] + [axis.direction for axis in axes]
    points = [plane.project(found.centre[None])[0] for plane in planes]
    points += [axis.point for axis in axes]
    orders = ["∞" if axis.continuous else str(axis.order) for axis in axes]
    columns: dict[str, list[Any]] = {
        "Element": [*["plane"] * len(planes), *["axis"] * len(axes)],
        "Order": [*[""] * len(planes), *orders],
    }
    for number, name in enumerate("RAS"):
        columns[f"Direction {name}"] = [float(each[number]) for each in directions]
        columns[f"Point {name}"] = [float(each[number]) for each in points]
    return columns


def _pair_columns(
    pairs: NDArray[np.int64], apart: NDArray[np.float64], odd: NDArray[np.int64], names: list[str]
) -> dict[str, list[Any]]:
    """A row a pair, then one each landmark on the midline, then those without a counterpart."""
    return {
        "Landmark": [names[number] for number in (*pairs[:, 0], *odd)],
        "Partner": [*(names[number] for number in pairs[:, 1]), *[""] * len(odd)],
        "Distance": [*apart.tolist(), *[np.nan] * len(odd)],
    }
