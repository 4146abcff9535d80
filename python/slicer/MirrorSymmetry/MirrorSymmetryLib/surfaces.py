"""The surface that a node of the scene holds, in world coordinates (RAS, mm)."""

from __future__ import annotations

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkCommonTransforms import vtkGeneralTransform
from vtkmodules.vtkFiltersCore import vtkCleanPolyData
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter

import slicer


def world_surface(node: slicer.vtkMRMLNode, segment: str = "") -> vtkPolyData:
    """Of a model, or of a segment of a segmentation.

    Args:
        node: a vtkMRMLModelNode or a vtkMRMLSegmentationNode.
        segment: the segment's ID or name; "" where there is one segment alone.

    Raises:
        ValueError: another node, one without a surface, or a segment that is not there.
    """
    if node is None:
        raise ValueError("no shape is chosen; allowed is a model or a segmentation")
    if node.IsA("vtkMRMLModelNode"):
        surface = node.GetPolyData()
    elif node.IsA("vtkMRMLSegmentationNode"):
        surface = _surface_of_segment(node, segment)
    else:
        raise ValueError(
            f"{node.GetName()} is a {node.GetClassName()}; allowed is a model or a segmentation"
        )
    if surface is None or surface.GetNumberOfPoints() == 0:
        raise ValueError(f"{node.GetName()} has no surface")
    return _in_world(_finite(surface), node)


def segments_of(node: slicer.vtkMRMLSegmentationNode) -> dict[str, str]:
    """The names of the segments, by their IDs."""
    segmentation = node.GetSegmentation()
    ids = [segmentation.GetNthSegmentID(i) for i in range(segmentation.GetNumberOfSegments())]
    return {each: segmentation.GetSegment(each).GetName() for each in ids}


def _surface_of_segment(node: slicer.vtkMRMLSegmentationNode, segment: str) -> vtkPolyData:
    segments = segments_of(node)
    chosen = [each for each, name in segments.items() if segment in (each, name)]
    if not segment and len(segments) == 1:
        chosen = list(segments)
    if not chosen:
        raise ValueError(
            f"the segment is {segment!r}; {node.GetName()} has {', '.join(segments.values()) or 'none'}"
        )
    surface = vtkPolyData()
    if not node.CreateClosedSurfaceRepresentation():
        raise ValueError(f"{node.GetName()} cannot be turned into surfaces")
    node.GetClosedSurfaceRepresentation(chosen[0], surface)
    return surface


def _finite(surface: vtkPolyData) -> vtkPolyData:
    """Without the points that are not finite, which some scans have, and their cells."""
    points = vtk_to_numpy(surface.GetPoints().GetData())
    broken = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if not len(broken):
        return surface
    copy, cells = vtkPolyData(), vtkIdList()
    copy.DeepCopy(surface)
    copy.BuildLinks()
    for point in broken.tolist():
        copy.GetPointCells(point, cells)
        for number in range(cells.GetNumberOfIds()):
            copy.DeleteCell(cells.GetId(number))
    copy.RemoveDeletedCells()
    used = vtkCleanPolyData()  # leaves out points without cells
    used.PointMergingOff()
    used.SetInputData(copy)
    used.Update()
    return used.GetOutput()


def _in_world(surface: vtkPolyData, node: slicer.vtkMRMLTransformableNode) -> vtkPolyData:
    parent = node.GetParentTransformNode()
    if parent is None:
        return surface
    to_world = vtkGeneralTransform()
    slicer.vtkMRMLTransformNode.GetTransformBetweenNodes(parent, None, to_world)
    moved = vtkTransformPolyDataFilter()
    moved.SetInputData(surface)
    moved.SetTransform(to_world)
    moved.Update()
    return moved.GetOutput()
