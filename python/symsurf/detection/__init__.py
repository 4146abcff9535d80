"""Finding a mirror, and matching points over a known one."""

from __future__ import annotations

from typing import Any, Literal, overload

from numpy.typing import ArrayLike

from .. import _core
from ..base.descriptions import renamed
from ..base.lengths import as_fractions
from ..base.options import Reading, documented, part
from ..base.progress import Progress
from ..reading.inputs import as_input, refuses, warn
from ..reading.splitting import parts_of
from ..results import Result, mirror_of
from .faint_points import faint_statistics, without_faint
from .repeating import deviations, half_samples, require_repeat
from .summaries import summary_in, summary_statistics


@overload
def detect(
    shape: object,
    method: str = "auto",
    *,
    parts: None = None,
    faces: ArrayLike | None = None,
    use_faces: bool = True,
    normals: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    absolute: bool = False,
    repeat: int = 0,
    seed: int = 0,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Result[_core.Mirror]: ...
@overload
def detect(
    shape: object, method: str = "auto", *, parts: str | ArrayLike, **options: Any
) -> list[Result[_core.Mirror]]: ...
@documented
@renamed(points="shape")
def detect(
    shape: object,
    method: str = "auto",
    *,
    parts: str | ArrayLike | None = None,
    faces: ArrayLike | None = None,
    use_faces: bool = True,
    normals: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    nonfinite: str = "skip",
    threshold: float | None = None,
    label: int | str | None = None,
    scalars: str | None = None,
    external_files: bool = False,
    absolute: bool = False,
    repeat: int = 0,
    seed: int = 0,
    threads: int = 0,
    progress: Progress | None = None,
    **parameters: object,
) -> Result[_core.Mirror] | list[Result[_core.Mirror]]:
    """Finds the mirror of a point set, a mesh or a mask.

    Args:
        shape: (n, 3) coordinates in any unit: an array, a nested list, a file to ``read``, a
            ``Shape``, a mesh or a cloud of PyVista, VTK, trimesh, Open3D, ITK or meshio, a table of
            pandas or polars with the columns x, y and z or with three that hold numbers, or another
            object with ``points`` or ``vertices``, with the ``faces`` or ``triangles`` that it has. A
            C-ordered float64 array is read in place. For a regular grid of PyVista (``ImageData``,
            ``RectilinearGrid``, a ``StructuredGrid`` with such points): the points, or the centres of
            the cells, chosen by ``threshold`` or ``label``, which become ``Result.points``; pairs are
            indices into them. An array of Dask or a ``PointSummary``: as for ``detect_chunks``.
        {Search}
        parts: search each part of a scene by itself, and return a list of results: "connected", the
            name of a point array with labels, or (n,) labels. Connected are the faces of a mesh that
            share corners, and points about three spacings apart. Parts of fewer than 10 points are
            ignored.
        faces: (m, 3) indices of points, if ``shape`` has none of its own. With faces the search, the
            score and the candidates use samples spread evenly over the surface; pairs are those of
            the points. The methods of the thesis use the points only.
        use_faces: False: ignore the faces and search with the points alone.
        normals: (n, 3) directions, one per point; their sign is ignored. Normals of a file, a shape
            or a mesh are used only if they are given here, in place of estimates, by
            ``perpendicular``, ``quadric``, ``separation_normals``, ``normals_only``, and ``auto``
            if it tries one of these.
        weights: (n,) how much each point counts, 0 to 1; None: those of the shape, the opacity of
            Gaussian splats. A point of weight 0.3 takes part as one of ten such points in three
            cases; which do depends on their numbers alone. The others get no partners.
        {Reading}
        absolute: True: parameters that are lengths (unit "diagonal") are given in input units, not
            as fractions of the diagonal of the bounding box. ``Result.parameters`` has fractions.
        repeat: number of random halves of the points in which the mirror is found again, 0 or
            [2, 10000]: ``statistics`` has the standard deviations "angle_sd" (degrees), "offset_sd"
            (input units, at the centroid) and "score_sd". They are upper estimates of those of
            several measurements, which ``repeatability`` gives: a half is sampled more coarsely.
        threads: number of threads; 0: all of the machine. The result does not depend on it.
        progress: called with the fraction done, on this thread; return False to cancel.
        **parameters: parameters of the method, as in ``methods()[method].parameters``.

    Raises:
        InvalidInput: too few finite points, not (n, 3), all on one point or line, an extent or a
            coordinate beyond what is allowed; not one normal per point, a normal that is not finite
            or zero; a face index out of range; a grid whose scalars do not choose points; a file
            that cannot be read.
        InvalidParameter: an unknown method or parameter, or a value out of its range.
        Cancelled: the progress callback returned False.

    A point set without symmetry is no error: its result has a low score, and the verdict "none".
    """
    refuse = refuses(nonfinite)
    require_repeat(repeat)
    reading = Reading(**part(Reading, locals()))
    if parts is not None:
        scene = parts_of(shape, parts, faces, reading, normals=normals, weights=weights)
        options: dict[str, Any] = parameters | {
            "use_faces": use_faces,
            "nonfinite": nonfinite,
            "absolute": absolute,
            "repeat": repeat,
            "seed": seed,
            "threads": threads,
            "progress": progress,
        }
        own = [None if normals is None else each.normals for each in scene]
        return [
            detect(each, method, normals=some, **options)
            for each, some in zip(scene, own, strict=True)
        ]
    summary = summary_in(shape)
    given = as_input(shape if summary is None else summary.means, faces, reading)
    used = given.faces if use_faces else None
    if absolute and method in _core.methods():
        described = _core.methods()[method].parameters
        parameters = as_fractions(
            parameters, described, lambda: _core.diagonal(given.points, method, refuse)
        )
    points, faint = given.points, 0
    weights = given.shape.weights if weights is None else weights
    if weights is not None:
        points, faint = without_faint(given.points, weights, refuse)
        refuse = False
    fields = _core.detect(
        points, used, method, normals, refuse, seed, threads, progress, parameters
    )
    if faint:
        fields["points"] = given.points
        fields["statistics"] |= faint_statistics(fields["statistics"], faint)
    if summary is not None:
        fields["statistics"] |= summary_statistics(summary)
    if repeat:
        again = half_samples(
            given.points,
            repeat,
            fields["mirror"],
            method=fields["method"],
            parameters=fields["parameters"],
            seed=seed,
            threads=threads,
        )
        fields["statistics"] |= deviations([made for _, made in again], given.points)
    warn(fields["statistics"])
    return Result.from_fields(fields | {"faces": given.faces, "space": given.space})


@renamed(points="shape")
def match(
    shape: object,
    mirror: Result | _core.Mirror | str,
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

    Use it to see how a mirror found elsewhere, or one of ``Result.candidates``, fits a point set.
    Outliers have no partners, as in ``detect``, and are ignored by the diagonal.

    Args:
        shape: (n, 3) coordinates, a file, a ``Shape`` or a mesh, as for ``detect``.
        mirror: the known mirror, a result that has one, or a plane such as "x=0".
        pair_distance: maximum distance between image and partner, as a fraction of the diagonal.
        tolerance: how far the two sides may differ and still count as symmetric, as a fraction of
            the diagonal in [1e-4, 0.1]: a point whose image lies this far from the surface counts
            half in the score.
        absolute: True: ``pair_distance`` is in input units.
        nonfinite, threshold, label, scalars, external_files, threads, progress: as for ``detect``.

    Returns:
        A result with the score and the verdict that ``detect`` gives such a mirror, and the pairs
        in the order of the points.

    Raises:
        InvalidInput: a result without a mirror, else as ``detect`` does.
        InvalidParameter: neither a mirror nor a result nor a plane, else as ``detect`` does.
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


MirrorShape = Literal["auto", "plane", "sphere", "cylinder", "quadric", "free-form"]


def fit_mirror(
    points: object, kind: MirrorShape = "auto", direction: ArrayLike | None = None
) -> _core.Mirror:
    """The mirror that points lie on, such as those of a mid-surface that was drawn or is known.

    Residuals are taken as Student's of 3 degrees, so that a third of the points may lie elsewhere.

    Args:
        points: (n, 3), a polyline, a file, a ``Shape`` or a mesh, as for ``detect``: its vertices
            count; or a result, whose surface points count.
        kind: of the mirror. "auto" takes the likeliest, in which each number more has to pay
            (Schwarz 1978): a plane has 3, a sphere 4, a cylinder 5, a quadric 9, a free form more.
        direction: (3,), along which the mirror maps: a plane becomes an ``ObliquePlane``, a free
            form a ``HeightField``.

    Returns:
        The mirror in input units. The points are its footprint.

    Raises:
        InvalidInput: fewer points than the kind has numbers, points that are not finite or lie on
            one line, that determine no mirror of the kind, or none along the direction.
        InvalidParameter: an unknown kind; one that takes no direction.
    """
    given = points.surface_points if isinstance(points, Result) else as_input(points).points
    return _core.fit_mirror(given, kind, direction)
