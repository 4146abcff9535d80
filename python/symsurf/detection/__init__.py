"""Finding a mirror, and matching points over a known one."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from ..base.descriptions import renamed
from ..base.lengths import as_fractions
from ..base.options import Reading, documented, part
from ..base.progress import Progress
from ..reading.inputs import as_input, refuses, warn
from ..results import Result, mirror_of
from .summaries import summary_in, summary_statistics


@documented
@renamed(points="shape")
def detect(
    shape: object,
    method: str = "auto",
    *,
    faces: ArrayLike | None = None,
    use_faces: bool = True,
    normals: ArrayLike | None = None,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    absolute: bool = False,
    seed: int = 0,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Result[_core.Mirror]:
    """Finds the mirror of a point set, a mesh or a mask.

    Args:
        shape: (n, 3) coordinates in any unit: an array, a nested list, a file to ``read``, a
            ``Shape``, a mesh or a cloud of PyVista, VTK, trimesh, Open3D, ITK or meshio, a table of
            pandas or polars with the columns x, y and z or with three that hold numbers, or another
            object with ``points`` or ``vertices``, with the ``faces`` or ``triangles`` that it has. A
            C-ordered float64 array is read in place. Of a regular grid of PyVista (``ImageData``, ``RectilinearGrid``, a
            ``StructuredGrid`` with such points) the points, or the centres of the cells, that
            ``threshold`` or ``label`` chooses: ``Result.points`` are then these, and pairs are indices into
            them. An array of Dask or a ``PointSummary``: as for ``detect_chunks``.
        {Search}
        faces: (m, 3) indices of points, where ``shape`` does not bring them. With faces, samples
            spread evenly over the surface find the mirror; score and candidates are those of the
            samples, pairs those of the points. The thesis's methods see the points only.
        use_faces: False: the points alone find the mirror, whatever faces there are.
        normals: (n, 3) directions, one a point; taken as lines, so their sign does not count. Those
            of a file, a shape or a mesh are not used unless they are given here. ``perpendicular``
            and ``quadric``, ``auto`` where it tries ``perpendicular``, ``separation_normals`` and
            ``normals_only`` use them in place of their own estimates; the other methods do not.
        {Reading}
        absolute: True: parameters that are lengths (those of the unit "diagonal") are in input
            units, in place of fractions of the diagonal of the bounding box. ``Result.parameters``
            has them as fractions.
        threads: 0 means as many as the machine has. The result does not depend on it.
        progress: called with the fraction done, on this thread; returning False cancels.
        **parameters: the method's own, by name: ``methods()[method].parameters``.

    Raises:
        InvalidInput: too few finite points, not (n, 3), all on one point or line, an extent or a
            coordinate beyond what is allowed; normals that are not one a point, not finite or zero;
            a face that names a point which is not there; a grid whose scalars do not say which
            points to take; a file that cannot be read.
        InvalidParameter: an unknown method or parameter, or a value out of its range.
        Cancelled: the progress callback returned False.

    A point set without symmetry is no error: its result has a low score, and the verdict "none".
    """
    refuse = refuses(nonfinite)
    reading = Reading(**part(Reading, locals()))
    summary = summary_in(shape)
    given = as_input(shape if summary is None else summary.means, faces, reading)
    used = given.faces if use_faces else None
    if absolute and method in _core.methods():
        described = _core.methods()[method].parameters
        parameters = as_fractions(
            parameters, described, lambda: _core.diagonal(given.points, method, refuse)
        )
    fields = _core.detect(
        given.points, used, method, normals, refuse, seed, threads, progress, parameters
    )
    if summary is not None:
        fields["statistics"] |= summary_statistics(summary)
    warn(fields["statistics"])
    return Result.from_fields(fields | {"faces": given.faces, "space": given.space})


@renamed(points="shape")
def match(
    shape: object,
    mirror: Result | _core.Mirror,
    pair_distance: float = 0.05,
    *,
    tolerance: float = 0.004,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    absolute: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
) -> Result[_core.Mirror]:
    """Pairs every point with the input point nearest to its image over a known mirror.

    How a mirror found elsewhere, or one of ``Result.candidates``, fits a point set. Points far off
    the rest have no partners, as in ``detect``, and do not count for the diagonal.

    Args:
        shape: (n, 3) coordinates, a file, a ``Shape`` or a mesh, as for ``detect``.
        mirror: the known mirror, or a result that has one.
        pair_distance: how far from the image a partner may be, as a fraction of the diagonal.
        tolerance: how far the two sides may differ, as a fraction of the diagonal in [1e-4, 0.1]:
            where an image lies so far from the shape, across its surface, the score counts it half.
        absolute: True: ``pair_distance`` is in input units.
        nonfinite, threshold, label, scalars, external_files, threads, progress: as for ``detect``.

    Returns:
        A result with the score and the verdict that ``detect`` gives such a mirror, and the pairs
        in the order of the points.

    Raises:
        InvalidInput: a result without a mirror, else as ``detect`` does.
        InvalidParameter: neither a mirror nor a result, else as ``detect`` does.
        Cancelled: as ``detect`` does.
    """
    mirror = mirror_of(mirror)
    refuse = refuses(nonfinite)
    reading = Reading(**part(Reading, locals()))
    given = as_input(shape, reading=reading)
    if absolute:
        pair_distance /= _core.diagonal(given.points, "auto", refuse)
    fields = _core.match(
        given.points, given.faces, mirror, pair_distance, tolerance, refuse, threads, progress
    )
    warn(fields["statistics"])
    return Result.from_fields(
        fields | {"mirror": mirror, "faces": given.faces, "space": given.space}
    )
