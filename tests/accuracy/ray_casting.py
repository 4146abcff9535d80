"""Light that a mirror throws onto a screen, counted ray by ray: what ``irradiance`` is held against.

Rays from the light, one at random in each cell of a grid, meet a fine mesh of the mirror in VTK's cell
locator and leave by the law of reflection, with the mesh's own normals. Each carries the solid angle it
stands for to the cell of the screen where it ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import symsurf

from .poses import Points

RAYS = 350  # along each side of what the mirror's mesh shades
MESH = 240  # cells along each side, and a margin around, where rays do not count
MARGIN = 1.1
CELLS = 4  # of the screen, along each side
# Parts of a cell, along each side, each with samples of the irradiance of its own: so many, and of
# these as the rays are shared out. Near a caustic the irradiance has no finite variance over a part, so
# that narrow parts count for more than many samples: in 12 a cell, their noise was up to 7 %.
FINE, LEAST, SHARED = 36, 1, 30_000


@dataclass(frozen=True)
class LitMirror:
    """A mirror over x and y of -1 to 1, its height there, and a light above it."""

    mirror: symsurf.Mirror
    height: Callable[[np.ndarray, np.ndarray], np.ndarray]
    light: np.ndarray


@dataclass(frozen=True)
class Screen:
    """The square of a plane of constant z."""

    middle: np.ndarray
    half: float

    def spread(self, counts: np.ndarray, rng: np.random.Generator) -> Points:
        """So many at random in each of (n, n) squares, which stand in rows."""
        n = len(counts)
        corners = np.repeat(np.indices((n, n)).reshape(2, -1), counts.ravel(), axis=1)
        x, y = (2 * (corners + rng.uniform(size=corners.shape)) / n - 1) * self.half
        return np.column_stack([x, y, np.zeros_like(x)]) + self.middle

    def summed(self, points: Points, weights: np.ndarray, n: int = CELLS) -> np.ndarray:
        """(n, n), in each of so many squares."""
        edges = np.linspace(-self.half, self.half, n + 1)
        x, y = (points - self.middle)[:, :2].T
        return np.histogram2d(x, y, (edges, edges), weights=weights)[0]


def cast(lit: LitMirror, height: float, rng: np.random.Generator) -> tuple[Points, np.ndarray]:
    """Where reflected rays meet the plane z = height, and the solid angle each carries."""
    mesh = _mesh(lit)
    locator = vtk.vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    ways, solid = _ways(vtk_to_numpy(mesh.GetPoints().GetData()), lit.light, rng)
    reach = 4 * np.abs(lit.light).sum()
    hits, normals = _hits(mesh, locator, lit.light, lit.light + reach * ways)
    inside = np.abs(hits[:, :2]).max(axis=1) <= 1
    ways -= 2 * (ways * normals).sum(axis=1)[:, None] * normals
    with np.errstate(invalid="ignore", divide="ignore"):
        far = (height - hits[:, 2]) / ways[:, 2]
    known = inside & (far > 0)
    return (hits + far[:, None] * ways)[known], solid[known]


def thrown(
    lit: LitMirror, screen: Screen, ends: Points, solid: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """(CELLS, CELLS) what symsurf's irradiance sums up to in each cell; more samples where rays
    end."""
    n = CELLS * FINE
    guide = screen.summed(ends, solid, n)
    counts = LEAST + np.ceil(SHARED * guide / guide.sum()).astype(int)
    points = screen.spread(counts, rng)
    area = np.repeat(((2 * screen.half / n) ** 2 / counts).ravel(), counts.ravel())
    sources, flux = seen(lit, points)
    return screen.summed(points[sources], flux * area[sources])


def seen(lit: LitMirror, points: Points) -> tuple[np.ndarray, np.ndarray]:
    """Of each way over the square to points of a screen above the mirror: its point, and the
    irradiance of the screen."""
    found = lit.mirror.reflection_points(points, lit.light)  # light takes its way back as well
    ends = points[found.sources]
    ways = ends - found.positions
    x, y, z = found.positions.T
    counts = (np.abs(x) <= 1) & (np.abs(y) <= 1) & (ways[:, 2] > 0)
    counts &= np.abs(z - lit.height(x, y)) < 1e-3  # the side of a sphere that the rays meet
    cosine = np.abs(ways[:, 2]) / np.linalg.norm(ways, axis=1)
    return found.sources[counts], (found.irradiance * cosine)[counts]


def _ways(
    vertices: Points, light: np.ndarray, rng: np.random.Generator
) -> tuple[Points, np.ndarray]:
    """Unit vectors from the light, through the shadow of all vertices on z = 0, and the solid angle
    around each."""
    shadow = light + (vertices - light) * (light[2] / (light[2] - vertices[:, 2:]))
    low, sides = shadow.min(axis=0), np.ptp(shadow, axis=0) / RAYS
    cells = np.indices((RAYS, RAYS)).reshape(2, -1).T
    ways = -np.tile(light, (len(cells), 1))
    ways[:, :2] += low[:2] + (cells + rng.uniform(size=cells.shape)) * sides[:2]
    lengths = np.linalg.norm(ways, axis=1)
    return ways / lengths[:, None], sides[0] * sides[1] * light[2] / lengths**3


def _mesh(lit: LitMirror) -> vtk.vtkPolyData:
    """Of triangles, with normals averaged at its vertices."""
    side = np.linspace(-MARGIN, MARGIN, MESH + 1)
    x, y = (each.ravel() for each in np.meshgrid(side, side, indexing="ij"))
    corners = np.arange((MESH + 1) ** 2).reshape(MESH + 1, -1)
    a, b, c, d = corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]
    faces = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)
    shape = symsurf.Shape(np.column_stack([x, y, lit.height(x, y)]), faces)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(shape.to_pyvista())
    normals.SplittingOff()
    normals.Update()
    return normals.GetOutput()


def _hits(
    mesh: vtk.vtkPolyData, locator: vtk.vtkStaticCellLocator, start: np.ndarray, ends: Points
) -> tuple[Points, Points]:
    """(n, 3) the first point of the mesh on each way, NaN where there is none, and its normal."""
    t, where, at = vtk.mutable(0.0), [0.0] * 3, [0.0] * 3
    part, cell = vtk.mutable(0), vtk.mutable(0)
    hits, cells, shares = np.full((len(ends), 3), np.nan), np.zeros(len(ends), int), []
    for i, end in enumerate(ends):
        found = locator.IntersectWithLine(start, end, 0.0, t, where, at, part, cell)
        if found:
            hits[i], cells[i] = where, int(cell)
        shares.append((1 - at[0] - at[1], at[0], at[1]))
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)[cells]
    normals = vtk_to_numpy(mesh.GetPointData().GetNormals()).astype(float)[corners]
    normals = (np.array(shares)[:, :, None] * normals).sum(axis=1)
    return hits, normals / np.linalg.norm(normals, axis=1, keepdims=True)
