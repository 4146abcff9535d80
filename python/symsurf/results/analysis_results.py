"""What analyses give: a class each."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput, InvalidParameter, Plane
from ..base.input_warning import warn_of
from ..shapes import Shape
from .base_result import BaseResult
from .elements import Axis, TolerancedGroup, Transformation, toleranced_group
from .outputs import plot
from .poses import extents, isaac_axes, nearest_poses, rigid, stepped
from .summary import value_text

if TYPE_CHECKING:
    from pyvista import Plotter
    from typing_extensions import Self


@dataclass(frozen=True, eq=False, repr=False)
class AnalysisResult(BaseResult):
    """The result of an analysis."""

    analysis: ClassVar[str]
    """Its name in ``analyses()``."""

    shape: Shape
    """The input."""
    arrays: dict[str, NDArray[Any]]
    """Arrays of the analysis at the points of ``shape``, by the names in its description; NaN, -1
    or False at points that are not finite."""
    planes: list[Plane]
    """Mirror planes."""
    axes: list[Axis]
    """Axes of rotation."""
    transformations: list[Transformation]
    """Maps of the shape, or of a part of it, onto another part."""
    parameters: dict[str, Any]
    """Every parameter of the analysis, as used."""
    statistics: dict[str, Any]
    """Other figures of the analysis."""
    seconds: float
    """Run time in seconds."""

    @classmethod
    def from_fields(cls, shape: Shape, made: dict[str, Any]) -> Self:
        """From what the core gives."""
        return cls(
            shape=shape,
            arrays=made["arrays"],
            planes=made["planes"],
            axes=[Axis(*axis) for axis in made["axes"]],
            transformations=[Transformation(*each) for each in made["transformations"]],
            parameters=made["parameters"],
            statistics=cls.in_order(made["statistics"]),
            seconds=made["seconds"],
        )

    @property
    def summary(self) -> dict[str, str]:
        """A short text per name: the analysis, numbers of elements found, statistics."""
        words = {"analysis": self.analysis}
        for name in ("planes", "axes", "transformations"):
            if found := getattr(self, name):
                words[name] = str(len(found))
        for name, value in self.statistics.items():
            words[name.replace("_", " ")] = value_text(name, value)
        return words

    def __repr__(self) -> str:
        found = ", ".join(
            f"{len(getattr(self, name))} {name}"
            for name in ("planes", "axes", "transformations")
            if getattr(self, name)
        )
        return f"{type(self).__name__}({self.shape!r}{', ' if found else ''}{found})"

    def to_json(self) -> dict[str, Any]:
        """Every field but the shape and its arrays by its name, in what ``json.dumps`` takes; an
        axis has the order "continuous" in place of 0, a transformation "from" and "onto"."""
        return {
            "analysis": self.analysis,
            "planes": [
                {"normal": plane.normal.tolist(), "offset": plane.offset} for plane in self.planes
            ],
            "axes": [
                {
                    "point": axis.point.tolist(),
                    "direction": axis.direction.tolist(),
                    "order": axis.order or "continuous",
                }
                for axis in self.axes
            ],
            "transformations": [
                {
                    "kind": each.kind,
                    "matrix": each.matrix.tolist(),
                    "score": each.score,
                    "from": each.from_points.tolist(),
                    "onto": each.onto_points.tolist(),
                }
                for each in self.transformations
            ],
            **super().to_json(),
        }

    def plot(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        camera: Any = None,
        title: bool = True,
    ) -> Plotter:
        """Draws the shape, coloured by the main array of the analysis, with planes and axes; needs
        PyVista.

        Args:
            path: a PNG file to write, off-screen; None: opens a window.
            camera: as for ``Result.plot``.
            title: False: omit the title.
        """
        return plot(self, path, camera=camera, title=title)


@dataclass(frozen=True, eq=False, repr=False)
class Symmetries(AnalysisResult):
    """The symmetries of a shape: its point group.

    ``planes`` has all mirror planes; of a continuous group one that holds the axis and the one
    across it, where there is one; of K none. ``axes`` has all rotation axes, the highest order first,
    a continuous one before; of D∞h one of those of order 2, of K three at right angles.
    ``transformations`` has every element, the identity first; of a continuous group those that,
    with the turns about the continuous axes, make up all.
    """

    analysis = "symmetries"

    by_tolerance: list[TolerancedGroup] = field(default_factory=list)
    """The groups that hold within larger and larger tolerances, each of which contains the one
    before, from C1 on up to an eighth of the diameter; ``group`` is one of them."""

    @classmethod
    def from_fields(cls, shape: Shape, made: dict[str, Any]) -> Self:
        """From what the core gives."""
        chain = [toleranced_group(each) for each in made["by_tolerance"]]
        return replace(super().from_fields(shape, made), by_tolerance=chain)

    @property
    def group(self) -> str:
        """In Schoenflies' notation: "C1", "Cs", "D6h", "Oh", "C∞v", "D∞h", "K", ..."""
        return self.statistics["group"]

    @property
    def centre(self) -> NDArray[np.float64]:
        """(3,) in input units: the fixed point of all elements."""
        return self.statistics["centre"]

    @property
    def inversion(self) -> bool:
        """Whether x -> 2 centre - x maps the shape onto itself."""
        return self.statistics["inversion"]

    @property
    def score(self) -> float:
        """How well the images under all elements match the shape, 0 to 1; images in missing parts
        are ignored."""
        return self.statistics["score"]

    @property
    def missing(self) -> float:
        """Share of the images that lie where the shape has no points, in parts that are cut
        away."""
        return self.statistics["missing"]

    @property
    def max_deviation(self) -> NDArray[np.float64]:
        """(n,) maximum deviation of each element, in input units: the greatest distance of an image
        from the surface, that is from triangles, the tangent planes of a cloud, or the nearest of up to
        1000 points; images beyond a rim are ignored."""
        return self.statistics["max_deviations"].ravel()

    @property
    def quantile_deviation(self) -> NDArray[np.float64]:
        """(n,) 95 % quantile of the same distances, over samples by area."""
        return self.statistics["quantile_deviations"].ravel()

    @property
    def elements(self) -> NDArray[np.float64]:
        """(n, 4, 4): the matrices of ``transformations``."""
        return np.array([each.matrix for each in self.transformations])

    @property
    def order(self) -> int | None:
        """Number of elements of the group; None for a continuous (infinite) group."""
        is_continuous = any(axis.continuous for axis in self.axes)
        return None if is_continuous else len(self.transformations)

    def __repr__(self) -> str:
        return (
            f"Symmetries({self.group}, {len(self.planes)} planes, {len(self.axes)} axes, "
            f"score {self.score:.3f})"
        )

    def to_json(self) -> dict[str, Any]:
        """What every analysis gives, with the group, its centre, ``inversion``, ``elements`` as lists
        of rows, ``score``, ``missing`` and ``by_tolerance`` by name, in what ``json.dumps`` takes."""
        return {
            **super().to_json(),
            "group": self.group,
            "centre": self.centre.tolist(),
            "inversion": self.inversion,
            "elements": self.elements.tolist(),
            "score": self.score,
            "missing": self.missing,
            "by_tolerance": [
                {"tolerance": each.tolerance, "group": each.group, "quantile": each.quantile}
                for each in self.by_tolerance
            ],
        }

    @property
    def axis_max_deviation(self) -> NDArray[np.float64]:
        """(k,) the same for the rotations about each continuous axis, in the order of ``axes``."""
        return np.ravel(self.statistics.get("axis_max_deviations", ()))

    @property
    def axis_quantile_deviation(self) -> NDArray[np.float64]:
        """(k,) the same for ``quantile_deviation``."""
        return np.ravel(self.statistics.get("axis_quantile_deviations", ()))

    def nearest(self, pose: ArrayLike, to: ArrayLike | None = None) -> NDArray[np.float64]:
        """Finds the pose nearest to another one among all poses in which the shape looks the same.

        A pose maps the shape's coordinates to those of a camera or the world. Equivalent ones are
        ``pose @ S`` for each rotation S of the group; about a continuous axis the best angle is
        computed. Nearest is the one by the least angle of rotation: all place the centre of the group
        alike, so that translations do not tell them apart. Of several as near, the given pose comes
        first, then the order of ``transformations``.

        Args:
            pose: (4, 4), or (k, 4, 4) of a sequence.
            to: (4, 4), or one for each pose; without it each pose of a sequence is taken nearest to
                the one before it, as that is given back: what a tracker gave jumps no more.

        Returns:
            (4, 4) or (k, 4, 4), as ``pose``.

        Raises:
            InvalidInput: naming what is no rigid motion; a number of poses to be nearest to that is
                neither one nor that of ``pose``; a single pose without ``to``.
        """
        poses = rigid("pose", pose)
        if to is None and np.ndim(pose) == 2:
            raise InvalidInput(
                "to is None and pose is one; allowed without to is a sequence (k, 4, 4)"
            )
        turns, axes = self._rotations(None)
        if to is not None:
            others = rigid("to", to)
            if len(others) not in (1, len(poses)):
                raise InvalidInput(
                    f"to has {len(others)} poses, pose {len(poses)}; allowed is one, or as many"
                )
            found = nearest_poses(poses, others, turns, axes)
        else:
            found = poses
            for k in range(1, len(poses)):
                found[k : k + 1] = nearest_poses(poses[k : k + 1], found[k - 1 : k], turns, axes)
        return found.reshape(np.shape(pose))

    def to_bop(
        self, tolerance: float | None = None, points: ArrayLike | None = None
    ) -> dict[str, Any]:
        """The rotations as an entry of the BOP toolkit's ``models_info.json`` has them.

        ``symmetries_discrete``: 4 x 4 matrices, row by row in lists of 16, without the identity;
        ``max_deviation``: of each of these how far it takes the shape off itself, beside what the
        toolkit reads; ``symmetries_continuous``: dictionaries with axis and offset, a point on the
        axis. Each is left out where there are none. Lengths are in the unit of the input; the toolkit's is the
        millimetre. Reflections, which no object can be moved by, are not among them.

        Args:
            tolerance: the greatest ``max_deviation`` and ``axis_max_deviation`` of those to take, a
                length in input units; without it all. The BOP challenge takes the larger of 15 mm
                and a tenth of the diameter.
            points: (n, 3) of the model: with them the entry has ``diameter``, ``min_x`` and ``size_x``
                and the like, too, and is complete.

        Raises:
            InvalidParameter: a tolerance below 0 or not finite.
        """
        taken = self._taken(tolerance)[1:]
        turns = self.elements[1:][taken]
        _, axes = self._rotations(tolerance)
        entry: dict[str, Any] = {} if points is None else extents(points)
        if len(turns):
            entry["symmetries_discrete"] = [turn.ravel().tolist() for turn in turns]
            entry["max_deviation"] = self.max_deviation[1:][taken].tolist()
        if axes:
            entry["symmetries_continuous"] = [
                {"axis": axis.direction.tolist(), "offset": axis.point.tolist()} for axis in axes
            ]
        return entry

    def to_foundationpose(
        self, step: float = 5.0, tolerance: float | None = None
    ) -> NDArray[np.float64]:
        """The rotations as ``symmetry_tfs`` of FoundationPose, which its own reader of
        ``models_info.json`` makes only of axes along x, y or z through the origin.

        Args:
            step: degrees between turns about a continuous axis, above 0 and at most 180; of a ball 30
                at least, as FoundationPose takes poses by less for one.
            tolerance: as of ``to_bop``.

        Returns:
            (k, 4, 4), the identity first, in input units; FoundationPose's is the metre.

        Raises:
            InvalidParameter: a step or a tolerance out of range.
        """
        return stepped(*self._rotations(tolerance), step)

    def to_isaac(self, tolerance: float | None = None) -> dict[str, list[str]]:
        """The rotations as parameters of Isaac ROS FoundationPose: ``symmetry_axes``, such as
        "x_full" for any turn about x and "y_180" for one by 180 degrees about y.

        The older parameter ``symmetry_planes`` is deprecated, and its "x" means "x_180". Rotations
        about other axes than x, y and z have no name there: they are left out, with an
        ``InputWarning``, and the products of those that are named are rotations of the shape, too.

        Args:
            tolerance: as of ``to_bop``.

        Raises:
            InvalidParameter: a tolerance below 0 or not finite.
        """
        names, left_out = isaac_axes(*self._rotations(tolerance))
        if left_out:
            message = (
                f"{left_out} rotations are no products of those about x, y and z, and Isaac has no name "
                "for them; turn the model so that its axes of symmetry are along these"
            )
            warn_of([message])
        return {"symmetry_axes": names}

    def _rotations(self, tolerance: float | None) -> tuple[NDArray[np.float64], list[Axis]]:
        """(k, 4, 4), the identity first, and the continuous axes; those within the tolerance."""
        continuous = [axis for axis in self.axes if axis.continuous]
        if tolerance is not None:
            near = self.axis_max_deviation <= tolerance
            continuous = [axis for axis, is_near in zip(continuous, near) if is_near]
        return self.elements[self._taken(tolerance)], continuous

    def _taken(self, tolerance: float | None) -> NDArray[np.bool_]:
        """(n,) of the elements: which are rotations within the tolerance."""
        is_turn = np.linalg.det(self.elements[:, :3, :3]) > 0
        if tolerance is None:
            return is_turn
        if not (np.isfinite(tolerance) and tolerance >= 0):
            raise InvalidParameter(f"tolerance is {tolerance!r}; allowed is [0, inf)")
        return is_turn & (self.max_deviation <= tolerance)


@dataclass(frozen=True, eq=False, repr=False)
class SymmetryEmbedding(AnalysisResult):
    """The Symmetry Factored Embedding of a point set, its orbits and its stationary set.

    ``transformations`` has the motions and reflections that it rests on, the identity first;
    ``planes`` or ``axes`` the stationary set, where that is a plane or a line.
    """

    analysis = "symmetry_embedding"

    @property
    def orbit(self) -> NDArray[np.int64]:
        """(n,) the number of each point's orbit, from 0 on."""
        return self.arrays["orbit"]

    @property
    def embedding(self) -> NDArray[np.float64]:
        """(n, 16): the first coordinates, zeros where there are fewer."""
        return self.arrays["embedding"]

    @property
    def stationary_set(self) -> str:
        """What all symmetries keep in its place: "point", "line", "plane", or "none"."""
        return self.statistics["stationary_set"]

    def __repr__(self) -> str:
        return (
            f"SymmetryEmbedding({self.statistics['orbits']} orbits, "
            f"{len(self.transformations)} symmetries, stationary {self.stationary_set})"
        )


@dataclass(frozen=True, eq=False, repr=False)
class IntrinsicSymmetry(AnalysisResult):
    """Left-right correspondences of a posed body."""

    analysis = "intrinsic_symmetry"

    @property
    def image(self) -> NDArray[np.int64]:
        """(n,) the point on the other side, -1 for none."""
        return self.arrays["image"]

    @property
    def confidence(self) -> NDArray[np.float64]:
        """(n,): 0 to 1, halved where the image of the image lies 2 % of the diagonal away."""
        return self.arrays["confidence"]

    @property
    def verdict(self) -> str:
        """ "found" or "none"; ``statistics["reason"]`` says why."""
        return self.statistics["verdict"]

    def __repr__(self) -> str:
        return (
            f"IntrinsicSymmetry({self.shape!r}, {self.verdict}, "
            f"confidence {self.statistics['confidence']:.3f})"
        )


@dataclass(frozen=True, eq=False, repr=False)
class PartialSymmetries(AnalysisResult):
    """Parts of a shape that a reflection, motion or similarity maps onto other parts.

    ``transformations`` has the maps, the largest well-fitting patch first, with the points of both
    patches. ``arrays["transformation"]`` is the first of them with a point in a patch, -1 where there
    is none, ``arrays["side"]`` 0 in the patch that is mapped and 1 in that it falls on.
    """

    analysis = "partial_symmetries"


@dataclass(frozen=True, eq=False, repr=False)
class RecurringParts(AnalysisResult):
    """The parts of a mesh or cloud that recur.

    ``transformations`` has the maps from the first instance of a part to each of its instances, the
    identity first, part after part: those that make up most of the feature lines come first.
    ``arrays["part"]`` and ``arrays["instance"]`` have for each point the numbers of its part and of its
    instance of that part, -1 for none.
    """

    analysis = "recurring_parts"

    @property
    def parts(self) -> list[list[Transformation]]:
        """The maps to the instances of each part, the identity first."""
        found: list[list[Transformation]] = []
        for each in self.transformations:
            if each.kind == "identity":
                found.append([])
            found[-1].append(each)
        return found

    def __repr__(self) -> str:
        counts = ", ".join(str(len(part)) for part in self.parts)
        return f"RecurringParts({self.shape!r}, instances of each part: {counts or 'none'})"


class _WithVerdict(AnalysisResult):
    """What is found or not, and says why."""

    @property
    def verdict(self) -> str:
        """ "found" or "none"."""
        return str(self.statistics["verdict"])

    @property
    def reason(self) -> str:
        """Why the verdict is what it is; empty where nothing is to be said."""
        return str(self.statistics["reason"])


@dataclass(frozen=True, eq=False, repr=False)
class PairMatch(_WithVerdict):
    """Two shapes of a pair, as a left and a right bone, laid onto each other.

    ``transformations`` has the one map, of the points of ``shape``, the left one.
    """

    analysis = "match_pair"
    FIRST = ("verdict", "reason", "score", "evidence")

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(4, 4), determinant -1: the reflection and rigid placement of left onto right, on columns
        (x, y, z, 1) in input units."""
        return self.transformations[0].matrix

    @property
    def score(self) -> float:
        """Share of both shapes that lies on the other, 0 to 1."""
        return float(self.statistics["score"])

    @property
    def index(self) -> NDArray[np.int64]:
        """(n,) of each point of left: the nearest point of right to its image; -1 for none."""
        return self.arrays["index"]

    def __repr__(self) -> str:
        return f"PairMatch({self.shape!r}, {self.verdict}, score {self.score:.3f})"


@dataclass(frozen=True, eq=False, repr=False)
class HelicalSymmetry(_WithVerdict):
    """The axis, pitch, handedness and extent of a spring, thread or drill.

    ``transformations`` has the screw motion by a quarter of a turn, ``arrays["helical"]`` marks the
    points of the helical part. Both are empty and False if the verdict is "none".
    """

    analysis = "helical_symmetry"
    FIRST = ("verdict", "reason", "handedness", "pitch", "length", "score", "evidence")

    @property
    def axis(self) -> Axis | None:
        """The axis through the middle of the helical part; None if the verdict is "none"."""
        return self.axes[0] if self.axes else None

    @property
    def pitch(self) -> float:
        """How far a full turn moves along the axis, input units, above 0; NaN if the verdict is
        "none"."""
        return float(self.statistics.get("pitch", np.nan))

    @property
    def handedness(self) -> str:
        """ "right", "left", or "" if the verdict is "none"."""
        return str(self.statistics.get("handedness", ""))

    @property
    def ends(self) -> NDArray[np.float64]:
        """(2, 3) the points of the axis where the helical part begins and ends, input units; NaN if
        the verdict is "none"."""
        if self.axis is None:
            return np.full((2, 3), np.nan)
        half = self.statistics["length"] / 2 * self.axis.direction
        return np.array([self.axis.point - half, self.axis.point + half])

    @property
    def score(self) -> float:
        """Share of the helical part that screw motions map onto the shape, 0 to 1."""
        return float(self.statistics["score"])

    def __repr__(self) -> str:
        found = f"{self.handedness}-handed, pitch {self.pitch:.4g}" if self.axis else "none"
        return f"HelicalSymmetry({self.shape!r}, {found}, score {self.score:.3f})"


RESULTS: dict[str, type[AnalysisResult]] = {
    kind.analysis: kind
    for kind in (
        Symmetries,
        PartialSymmetries,
        RecurringParts,
        SymmetryEmbedding,
        IntrinsicSymmetry,
        PairMatch,
        HelicalSymmetry,
    )
}
