"""What operations give: a class each, with the arrays of the operation as fields."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .._core import AttributeTransform, InvalidInput, Mirror, Plane, operations
from ..base.plain import plain
from ..shapes import Shape
from ..shapes.kinds import UNDIRECTED, carried_by
from ..shapes.objects import Remade, remade_like
from ..shapes.polygons import carried_polygons
from .base_result import BaseResult, mirror_record
from .elements import Axis
from .inspection import Band, Patch, bands_within, limits_of, patches_above
from .outputs import plot
from .result import Result
from .summary import figures, value_text

if TYPE_CHECKING:
    from pyvista import Plotter
    from typing_extensions import Self


@dataclass(frozen=True, eq=False, repr=False)
class OperationResult(BaseResult):
    """The result of an operation."""

    operation: ClassVar[str]
    """Its name in ``operations()``."""

    given: Shape
    """The input: the caller's own array if it could be read in place."""
    shape: Shape
    """The shape, moved or not: points and faces in the order of the input, then those added."""
    mirror: Mirror | None
    """The mirror that was used; one made by hand gets the shape as its footprint. None for a
    completion about an axis."""
    found: Result | None
    """The detection that found the mirror; None if the mirror was given or not needed."""
    parameters: dict[str, Any]
    """Every parameter of the operation, as used."""
    statistics: dict[str, Any]
    """Figures of the operation."""
    seconds: float
    """Run time in seconds, without that of finding the mirror."""
    sources: NDArray[np.int64]
    """(n,) for each point of ``shape``: the input point from which its attributes come."""
    face_sources: NDArray[np.int64]
    """(m,) the same of each face."""
    parents: NDArray[np.int64] | None
    """(n, k) input points whose values are interpolated for each point; None unless the result is a
    new mesh, as of ``symmetrize`` with ``triangles="mirrored"``, or values are transferred."""
    shares: NDArray[np.float64] | None
    """(n, k) interpolation weights of these points; each row sums to 1."""
    kinds: dict[str, str] = field(default_factory=dict, kw_only=True)
    """What arrays of the input's points are, by name, as given: see ``carried``."""

    @classmethod
    def from_fields(cls, made: dict[str, Any]) -> Self:
        """From what the core gives."""
        has_faces = len(made["faces"]) or made["given"].faces is not None
        faces = made["faces"] if has_faces else None
        own = [np.arange(len(made[rows])) for rows in ("points", "faces")]
        sources = [made[rows] for rows in ("point_sources", "face_sources")]
        has_parents = len(made["point_parents"]) > 0
        frame = {"ras": "RAS", "lps": "LPS"}.get(made["parameters"].get("frame", ""))
        point_sources, face_sources = (
            found if len(found) else each for found, each in zip(sources, own, strict=True)
        )
        images = point_sources
        if has_parents:  # others lie between several
            images = np.where(made["point_shares"].max(axis=1) == 1, point_sources, -1)
        given = made["given"]
        return cls(
            given=given,
            shape=Shape(
                made["points"],
                faces,
                space=frame or given.space,
                polygons=None
                if faces is None
                else carried_polygons(faces, face_sources, images, given),
            ),
            mirror=made["mirror"],
            found=made["found"],
            parameters=made["parameters"],
            statistics=cls.in_order(made["statistics"]),
            seconds=made["seconds"],
            sources=point_sources,
            face_sources=face_sources,
            parents=made["point_parents"] if has_parents else None,
            shares=made["point_shares"] if has_parents else None,
            kinds=made.get("kinds", {}),
            **made["arrays"],
            **made["face_arrays"],
            **cls._own_fields(made),
        )

    @staticmethod
    def _own_fields(made: dict[str, Any]) -> dict[str, Any]:
        """Those that are no arrays of the operation."""
        return {}

    @property
    def is_other(self) -> bool:
        """True if the result is a new mesh that shares no vertices or faces with the input."""
        return self.parents is not None and not operations()[self.operation].carries_values

    def carried(
        self, values: NDArray[Any], kind: str = "scalar", name: object = "values"
    ) -> NDArray[Any]:
        """Values at the points of ``shape`` from values at the input points, such as colours or
        texture coordinates: (n, ...) from (k, ...). Real numbers and colours of three or four bytes
        are interpolated between a point's ``parents``; others are those of its source.

        Args:
            kind: "scalar"; "label": always that of the source; "weight": interpolated; "position",
                "vector", "normal", "tensor" (symmetric: 6 numbers in VTK's order or 9), "quaternion"
                (w, x, y, z) or "harmonics" (of degrees 1 to 3, of three colours): turned and
                reflected as the points are, curved mirrors by their local Jacobian.

        Raises InvalidInput for another number of values, or of components for the kind.
        """
        require_one_a_point(values, self.given, name)
        if kind == "label":
            return values[self.sources]
        if kind == "weight" and values.dtype.kind != "f":
            values = values.astype(float)
        keeps_lengths = kind == "normal" and self.shares is not None  # also between others
        if kind in UNDIRECTED or not (self.turns or keeps_lengths):
            if self.parents is None or self.shares is None:
                return values[self.sources]
            return carried_values(values, self.sources, self.parents, self.shares)
        rows = self.sources[:, None] if self.parents is None else self.parents
        return carried_by(self._transform, values, kind, self._placed, rows, self.shares, name)

    @property
    def turns(self) -> bool:
        """Whether directions change, of some points at least."""
        return self._transform.turns

    @cached_property
    def _transform(self) -> AttributeTransform:
        return AttributeTransform.of_result(
            self.operation,
            self.given.points,
            self.shape.points,
            self.sources,
            self.parents,
            self.shares,
            self.arrays,
            self.parameters,
            self.statistics,
            self.mirror,
        )

    def _placed(
        self, points: NDArray[np.float64], jacobians: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Positions (n, 3) after the map that has these Jacobians."""
        if (matrix := self.statistics.get("matrix")) is not None:
            return points @ matrix[:3, :3].T + matrix[:3, 3]
        assert self.mirror is not None
        return self.mirror.reflect(points)

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "_transform"}

    @property
    def arrays(self) -> dict[str, NDArray[Any]]:
        """Arrays of the operation at the points of ``shape``, by name."""
        described = operations()[self.operation].arrays
        own = {array.name: getattr(self, array.name) for array in described}
        return {name: values for name, values in own.items() if values is not None}

    @property
    def face_arrays(self) -> dict[str, NDArray[Any]]:
        """The same for each face."""
        described = operations()[self.operation].face_arrays
        return {array.name: getattr(self, array.name) for array in described}

    def like(self, given: Any) -> Any:
        described = operations()[self.operation]
        is_other = self.is_other or described.adds_points
        made = Remade(
            points=self.shape.points,
            faces=self.shape.faces,
            moved=is_other or described.moves_points,
            face_sources=self.face_sources if is_other else None,
            given_faces=0 if self.given.faces is None else len(self.given.faces),
            carried=self.carried,
            keeps=not (is_other or described.carries_values),
            turns=self.turns,
            # Else points are moved each by itself: their normals are not known.
            carries_normals=not described.carries_values
            and (self.turns or not described.takes_mask),
            kinds=self.kinds,
            keeps_texture=described.carries_values,
            arrays=self.arrays,
            face_arrays={} if self.shape.faces is None else self.face_arrays,
            figures=self.statistics,
        )
        return remade_like(given, len(self.given.points), made)

    @property
    def summary(self) -> dict[str, str]:
        """A short text per name: operation, mirror and statistics; lengths with their share of the
        diagonal, unmatched shares if they are not 0."""
        words = {"operation": self.operation, "mirror": self._kind}
        for name, value, share in figures(self.statistics):
            words[name.replace("_", " ")] = value_text(name, value, share)
        return words

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.shape!r}, mirror: {self._kind})"

    @property
    def _kind(self) -> str:
        return "none" if self.mirror is None else self.mirror.kind

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        clim: float | None = None,
        camera: Any = None,
        score: bool = True,
    ) -> Plotter:
        """Draws the shape and its mirror, coloured by the main array of the operation; needs
        PyVista.

        Args:
            path: a PNG file to write, off-screen; None: opens a window.
            clim: upper end of the colour scale, above 0 and in % of the diagonal (for
                ``confidence`` and ``irradiance`` a plain number); None: the 98th percentile, for
                lengths at least 0.1.
            camera: as for ``Result.plot``.
            score: False: omit the title.
        """
        return plot(self, path, clim=clim, camera=camera, score=score)

    def to_json(self) -> dict[str, Any]:
        return {
            "operation": self.operation,
            "mirror": mirror_record(self.mirror),
            **super().to_json(),
        }


@dataclass(frozen=True, eq=False, repr=False)
class _OverMirror(OperationResult):
    mirror: Mirror
    """The mirror that was used; one made by hand gets the shape as its footprint. None of two shapes
    of a pair, whose ``statistics`` have "pair_score", "pair_verdict" and "pair_matrix", of the shape
    onto the other."""


@dataclass(frozen=True, eq=False, repr=False)
class Asymmetry(_OverMirror):
    """The distance of each point from its counterpart on the other side.

    ``statistics``: "matched_share" and "unmatched_share", of that "unmatched_without_image",
    "unmatched_past_rim", "unmatched_too_far" and "unmatched_turned", all as shares of the points;
    over the matched points "mean", "rms", "median", "p75", "p95",
    "p99" and "maximum" of the distances, "signed_mean" and "signed_deviation", in input units and,
    with "_of_diagonal" behind the name, as shares of the "diagonal"; of a mesh "positive_area" and
    "negative_area" with "area_index", (positive - negative) / (positive + negative); of a
    watertight one the same of the volume. 0 means symmetric. With homologous pairing
    "known_share", "detectable_tangential", the smallest asymmetry along the surface that the shape
    could show, two median ``vector_sd``, and, where less than half is known, "warning".
    """

    operation = "asymmetry"
    FIRST = ("rms", "mean", "maximum", "matched_share")

    vector: NDArray[np.float64]
    """(n, 3) vector from the point to its counterpart, input units; NaN without one."""
    distance: NDArray[np.float64]
    """(n,) length of the vector."""
    signed: NDArray[np.float64]
    """(n,) component of the vector along the outward normal: positive if the point lies too far
    in."""
    tangential: NDArray[np.float64]
    """(n,) component of the vector along the surface."""
    lateral: NDArray[np.float64]
    """(n,) component of the vector away from the mirror; NaN of two shapes."""
    matched: NDArray[np.bool_]
    """(n,) whether the point has a counterpart: none beyond a boundary of the surface, too far
    away, or with a different normal."""
    confidence: NDArray[np.float64]
    """(n,) 0 to 1: the cosine between the normals, halved if the closest image is one point spacing
    away; with homologous pairing ``known``."""
    vector_sd: NDArray[np.float64] | None = None
    """(n,) with homologous pairing the standard deviation of ``vector`` along the surface, input
    units; 0 where both sides have one triangulation, NaN without a counterpart."""
    known: NDArray[np.float64] | None = None
    """(n,) with homologous pairing the share of the variance along the surface that the shape
    explains, 0 to 1; NaN without a counterpart."""
    face: NDArray[np.int64] | None = None
    """(n,) for a mesh: the face on whose image the counterpart lies; -1 for none."""
    weights: NDArray[np.float64] | None = None
    """(n, 3) for a mesh: barycentric coordinates on that face."""
    bands: list[Band] = field(default_factory=list)
    """With ``bands``: area and share within each limit, ascending."""
    patches: list[Patch] = field(default_factory=list)
    """With ``bands``: the connected regions above the smallest limit, the worst first, with place, area
    and largest deviation. What is on one side alone has a patch on both."""

    def with_bands(self, bands: ArrayLike) -> Asymmetry:
        """The result with ``bands`` and ``patches`` for limits of the distance, in input units, and
        ``statistics["symmetry_value"]``: twice the largest distance from the mirror of a point midway
        between opposite points."""
        limits = limits_of(bands)
        value = float(np.nanmax(np.abs(self.lateral), initial=0))
        return replace(
            self,
            statistics=self.statistics | {"symmetry_value": value},
            bands=bands_within(self.shape, self.distance, limits),
            patches=patches_above(self.shape, self.distance, limits[0]),
        )

    def to_json(self) -> dict[str, Any]:
        return super().to_json() | self.inspection

    @property
    def inspection(self) -> dict[str, Any]:
        """``bands`` and ``patches``, where they were asked for, in what ``json.dumps`` takes."""
        if not self.bands:
            return {}
        rows = [vars(patch) | {"points": len(patch.points)} for patch in self.patches]
        return {"bands": plain([*map(vars, self.bands)]), "patches": plain(rows)}


@dataclass(frozen=True, eq=False, repr=False)
class Correspondences(_OverMirror):
    """Which point mirrors which. ``statistics``: "paired_share", and why the others are unmatched,
    as those of an asymmetry; with the pairing by topology how many "mirror_maps" of the largest
    part were compared, and "near_share", of vertices near to the images of their partners, 0 to 1.
    ``save`` also takes ``.mirror``, MakeHuman's table: the numbers of a
    point and its mirror point and l, r or m, where l is the side of positive signed distances."""

    operation = "correspondences"

    index: NDArray[np.int64]
    """(n,) index of the mirror point, of the point itself if it lies on the mirror, -1 for none."""
    confidence: NDArray[np.float64]
    """(n,) 0 to 1: the cosine between the normals, halved if the closest image is one point spacing
    away; with homologous pairing the share of the variance along the surface that the shape
    explains; with topology 1 or 0."""
    face: NDArray[np.int64] | None = None
    """(n,) for a mesh: the face closest to the image; -1 for none."""
    weights: NDArray[np.float64] | None = None
    """(n, 3) for a mesh: barycentric coordinates on that face."""


@dataclass(frozen=True, eq=False, repr=False)
class Alignment(_OverMirror):
    """The shape, moved so that its mirror plane is a coordinate plane."""

    operation = "align"

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4) rigid motion, never a reflection: ``matrix @ (x, y, z, 1)``."""
        return self.statistics["matrix"]


@dataclass(frozen=True, eq=False, repr=False)
class Symmetrized(_OverMirror):
    """The shape made symmetric. ``statistics``: "paired_share", and why the others are unmatched,
    as those of an asymmetry. With ``triangles="mirrored"`` one side and its image: ``partner`` is an
    exact permutation, ``carried`` takes attributes along."""

    operation = "symmetrize"

    paired: NDArray[np.bool_]
    """(n,) whether the point has a counterpart; otherwise it did not move."""
    partner: NDArray[np.int64] | None = None
    """(n,) with mirrored triangles: index of the point that is its image, its own on the mirror."""


@dataclass(frozen=True, eq=False, repr=False)
class Remeshed(_OverMirror):
    """One side with even triangles, and its image. ``statistics``: "edge_length", the mean of the
    result, in input units and, with "_of_diagonal" behind the name, as a share of the diagonal."""

    operation = "remesh"

    partner: NDArray[np.int64]
    """(n,) index of the point that is its image, its own on the mirror."""


@dataclass(frozen=True, eq=False, repr=False)
class Half(_OverMirror):
    """The shape on one side of the mirror. ``statistics``: "cap_faces", how many close it, and
    "open_curves", how many of the curves where it is cut do not close and are left open."""

    operation = "cut"

    on_mirror: NDArray[np.bool_]
    """(n,) whether the point lies on the mirror."""
    cap: NDArray[np.bool_]
    """(m,) whether the face lies within the mirror and closes the half."""


@dataclass(frozen=True, eq=False, repr=False)
class Transferred(_OverMirror):
    """Values of the points, carried to the other side. ``statistics``: "failed_points", how many have
    no counterpart, and why, as those of an asymmetry."""

    operation = "transfer"

    failed: NDArray[np.bool_]
    """(n,) whether the point has no counterpart to take values from: it keeps its own."""
    values: Any = None
    """What was given: an array (n, ...), or a dictionary of them; None where nothing was."""

    def displaced(self, vectors: NDArray[Any]) -> NDArray[np.float64]:
        """Displacements (n, 3) of the points, as shape keys have them, carried likewise: what comes
        from the other side is that of the displaced point's image, input units."""
        if self.parents is None or self.shares is None:
            raise InvalidInput("this result carries no values")
        require_one_a_point(vectors, self.given, "vectors")
        points = self.given.points
        images = self.mirror.reflect(points + vectors) - self.mirror.reflect(points)
        images = np.nan_to_num(images)  # of points that give nobody anything
        own = self.shares[:, :1] * vectors
        return own + (images[self.parents[:, 1:]] * self.shares[:, 1:, None]).sum(axis=1)


@dataclass(frozen=True, eq=False, repr=False)
class Illuminated(_OverMirror):
    """Light that a mirror throws onto points. ``statistics``: "lit_share", of the points those that a
    path leads to, and "most_paths", the largest number of paths."""

    operation = "illuminate"

    paths: NDArray[np.int64]
    """(n,) number of reflected paths from the light to the point."""
    irradiance: NDArray[np.float64]
    """(n,) irradiance over all paths for a light of unit intensity, per square input unit: on the
    surface of a mesh,
    across each path for a cloud; infinite in a focus."""
    reflection: NDArray[np.float64]
    """(n, 3) point where the shortest path meets the mirror, input units; NaN without one."""


@dataclass(frozen=True, eq=False, repr=False)
class Straightened(_OverMirror):
    """The shape, deformed so that its mirror is flat. ``statistics``: "normal" and "offset" of the
    plane that the mirror is then, how many "unplaced_points" have no foot on it, as they go rigidly
    with the nearest that has one, and "matrix" over an oblique plane."""

    operation = "straighten"

    @property
    def plane(self) -> Plane:
        """The plane into which the mirror was flattened."""
        return Plane(self.statistics["normal"], self.statistics["offset"])

    @property
    def matrix(self) -> NDArray[np.float64] | None:
        """(4, 4) affine map that removed the shear of an oblique plane, ``matrix @ (x, y, z, 1)``;
        None over other mirrors."""
        return self.statistics.get("matrix")

    def _placed(
        self, points: NDArray[np.float64], jacobians: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        if self.matrix is not None:
            return super()._placed(points, jacobians)
        return _core.bend(points, self.mirror, self.parameters["back"])


@dataclass(frozen=True, eq=False, repr=False)
class Completed(OperationResult):
    """The shape with missing parts added: images of the other side, or rotated copies about an
    axis.

    ``statistics``: "added_points", "added_faces" and "seam_faces"; over a mirror why points are
    unmatched, as those of an asymmetry; about an axis how many "turns" were made and "axis_point",
    "axis_direction" and "axis_order", 0 of a continuous one.
    """

    operation = "complete"

    origin: NDArray[np.int64]
    """(n,) of each point: 0 original, 1 mirrored, 2 of the seam between them."""
    patch: Shape
    """The added part, with the boundary points of the shape that its faces use; it has its own
    numbering."""

    @classmethod
    def from_fields(cls, made: dict[str, Any]) -> Self:
        """Without those of the input's faces that name a corner twice."""
        proper = (np.diff(np.sort(made["faces"], axis=1), axis=1) != 0).all(axis=1)
        rows = {name: made[name][proper] for name in ("faces", "face_sources")}
        return super().from_fields(made | rows)

    @property
    def axis(self) -> Axis | None:
        """The axis of the rotations; None if a mirror was used."""
        given = self.statistics
        if "axis_direction" not in given:
            return None
        return Axis(given["axis_point"], given["axis_direction"], given["axis_order"], self._ends)

    def _placed(
        self, points: NDArray[np.float64], jacobians: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        if self.axis is None:
            return super()._placed(points, jacobians)
        arms = points - self.axis.point
        return self.axis.point + (jacobians @ arms[..., None])[..., 0]

    @property
    def _ends(self) -> NDArray[np.float64]:
        """Of the axis as it is drawn: a tenth beyond the shape."""
        point, direction = self.statistics["axis_point"], self.statistics["axis_direction"]
        along = (self.shape.points - point) @ direction
        low, high = float(along.min()), float(along.max())
        margin = 0.1 * (high - low)
        return point + np.outer([low - margin, high + margin], direction)

    @staticmethod
    def _own_fields(made: dict[str, Any]) -> dict[str, Any]:
        first = len(made["faces"]) - added_faces(made["statistics"])
        return {"patch": _patch(made["points"], len(made["given"].points), made["faces"][first:])}


def added_faces(statistics: dict[str, Any]) -> int:
    """How many faces an operation added behind those of its input."""
    return sum(statistics.get(name, 0) for name in ("added_faces", "seam_faces"))


RESULTS: dict[str, type[OperationResult]] = {
    kind.operation: kind
    for kind in (
        Asymmetry,
        Correspondences,
        Alignment,
        Completed,
        Symmetrized,
        Straightened,
        Remeshed,
        Half,
        Transferred,
        Illuminated,
    )
}


def require_one_a_point(values: NDArray[Any], given: Shape, name: object) -> None:
    points = len(given.points)
    if values.ndim == 0 or len(values) != points:
        raise InvalidInput(
            f"{name} has shape {values.shape}; allowed is one value per point: ({points}, ...)"
        )


def carried_values(
    values: NDArray[Any],
    sources: NDArray[np.int64],
    parents: NDArray[np.int64],
    shares: NDArray[np.float64],
) -> NDArray[Any]:
    """Real numbers and colours, of three or four bytes, by the shares of the parents, others those of
    the sources."""
    is_colour = values.dtype == np.uint8 and values.ndim == 2 and values.shape[1] in (3, 4)
    if not is_colour and values.dtype.kind != "f":
        return values[sources]
    counts = shares.reshape(*shares.shape, *[1] * (values.ndim - 1))
    mean = (values[parents] * counts).sum(axis=1)
    return (mean.round() if is_colour else mean).astype(values.dtype)


def _patch(points: NDArray[np.float64], given: int, faces: NDArray[np.int64]) -> Shape:
    """The faces with the points that they use; without faces, the points behind those given."""
    if not len(faces):
        return Shape(points[given:])
    used, corners = np.unique(faces, return_inverse=True)
    return Shape(points[used], corners.reshape(-1, 3))
