"""What results of detections, operations and analyses have in common."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from numpy.typing import NDArray

from .._core import Mirror
from ..base.input_warning import warn_of
from ..base.plain import plain
from ..shapes import Shape
from ..shapes.objects import Remade, remade_like
from .outputs import save
from .summary import Summarised


class BaseResult(Summarised):
    """A shape with arrays of its points, and figures."""

    FIRST: ClassVar[tuple[str, ...]] = ()
    """The statistics that matter first, in the order in which they are printed."""

    parameters: dict[str, Any]
    statistics: dict[str, Any]
    seconds: float

    if TYPE_CHECKING:  # fields of some classes

        @property
        def shape(self) -> Shape: ...

        @property
        def arrays(self) -> dict[str, NDArray[Any]]: ...

    @classmethod
    def in_order(cls, statistics: Mapping[str, Any]) -> dict[str, Any]:
        """The statistics, those that matter first in front; an index that is rounding is 0."""
        first = {name: statistics[name] for name in cls.FIRST if name in statistics}
        return {
            name: 0.0 if name.endswith("_index") and abs(value) < 1e-12 else value
            for name, value in (first | {**statistics}).items()
        }

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the result whole or not at all, in the format of the suffix.

        A shape that was read from a file of the same format keeps whatever else that file holds: of
        OBJ materials, groups, texture coordinates and polygons, of PLY all properties, of text all
        columns. Otherwise the file holds points, faces and, where it can, ``arrays``:

        ``.ply``: binary, ``arrays`` as properties of the points. ``.vtp``: for VTK, ParaView and
        PyVista, which read no such properties. ``.glb``: ``arrays`` as attributes "_NAME", all in
        single precision. ``.stl``, ``.obj`` and ``.off``: the shape alone. ``.csv`` and ``.npy``:
        ``arrays`` alone, one row per point, in the latter a structured array. ``.json``: what
        ``to_json`` gives, with ``arrays``.

        An InputWarning names what the file does not hold. Raises InvalidParameter for another suffix,
        InvalidInput for the STL of a cloud, OSError if nothing can be written.
        """
        warn_of(save(self, path))

    def like(self, given: Any) -> Any:
        """The shape as an object of the type of the one that was given.

        Args:
            given: that object: a mesh or a cloud of PyVista, trimesh, Open3D, ITK or meshio, or a
                table of pandas or polars.

        Returns:
            A new one with the points and faces of ``shape``, the attributes of the points and faces
            that they come from, and, if the type has room, ``arrays``; Open3D's older classes and
            ITK's have none. Normals of points that are moved or added
            go along in PyVista, unless each point moves by itself (``symmetrize``); other types lose them.

        Raises InvalidInput for another type, or another number of points.
        """
        made = Remade(
            self.shape.points,
            self.shape.faces,
            moved=False,
            arrays=self.arrays,
            figures=self.statistics,
        )
        return remade_like(given, len(self.shape.points), made)

    def to_json(self) -> dict[str, Any]:
        """Every field but the shape and its arrays by its name, in what ``json.dumps`` takes."""
        return {
            "parameters": plain(self.parameters),
            "statistics": plain(self.statistics),
            "seconds": self.seconds,
        }

    def json_arrays(self) -> dict[str, Any]:
        """What ``save`` writes to JSON beside that."""
        return {"space": self.shape.space, "arrays": plain(self.arrays)}


def mirror_record(mirror: Mirror | None) -> dict[str, Any] | None:
    return None if mirror is None else {"kind": mirror.kind} | plain(mirror.numbers)
