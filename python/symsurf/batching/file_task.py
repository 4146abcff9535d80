"""What is done with one file of many: read, find the mirror, operate, write; told in a record."""

from __future__ import annotations

import json
import math
import time
import warnings
from dataclasses import dataclass, field, fields, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInput, InvalidParameter, Mirror, analyses, needs_mirror
from ..base.input_warning import InputWarning
from ..base.options import Reading, Search, part
from ..base.plain import plain
from ..base.printable import printable
from ..base.progress import Progress, share
from ..detection import detect
from ..detection.chunks import detect_chunks
from ..detection.sampling import downsample
from ..mirror_operations.operate import FOUND_AT, operate
from ..reading import read, suffix_of
from ..reading.in_chunks import chunks_of, is_chunked
from ..reading.inputs import nonfinite_message
from ..reading.splitting import CONNECTED, named_array, parts_of
from ..report.page import shape_page
from ..results import AnalysisResult, Asymmetry, OperationResult, Result, Symmetries, found_mirror
from ..results.base_result import mirror_record
from ..saving import save_shape, write_whole
from ..saving.json_format import record_bytes
from ..saving.matches import save_matches
from ..shape_analyses.analyse import analyse
from ..shapes import Shape

DETECT = "detect"
SUMMARY_SUFFIX = ".summary.json"
PICTURE_SUFFIX = ".png"
PAGE_SUFFIX = ".html"
MATCHES_SUFFIX = ".matches.npy"

LARGE = 1 << 25
"""Points, of which the coordinates take 0.8 GB."""
_LEAST_BYTES = 1  # of a file for each of its points: LAZ packs them to a few

# Of a task: what it is done to, by and for, and what settings have under other names.
_NO_SETTINGS = {"file", "content", "threads", "outputs", "operation", "parameters"}

Record = dict[str, Any]
"""What is reported of a file, in what JSON knows. A file that failed has an "error"."""


@dataclass(frozen=True)
class FileTask(Reading, Search):
    """A file and what is done with it. It pickles: another process can do it."""

    file: Path
    """For ``content`` the name that records and outputs have."""
    operation: str = DETECT
    """Or the name of one of ``operations()`` or ``analyses()``."""
    parameters: dict[str, Any] = field(default_factory=dict)
    """Those of the operation or the analysis, and of the method where only the mirror is found."""
    threads: int = 0
    require_found: bool = False
    """Of an operation: a mirror with the verdict "none" is an error."""
    mirror: Mirror | None = None
    """Of an operation: the one to use, in place of that which the method finds."""
    other: Path | None = None
    """Of what takes two shapes: the second."""
    use_faces: bool = True
    use_normals: bool = False
    """Hand those of the file to the method; a file without any is an error."""
    downsample: float | None = None
    """Work on about one point in so many."""
    in_chunks: bool | None = None
    """Read the file in chunks, of which one at a time is in memory; None: where it holds more than
    ``LARGE`` points, its format allows it, and nothing else is asked for that needs them all."""
    input_format: str | None = None
    """Of the file; without it its suffix tells."""
    content: bytes | None = None
    """What is read in place of a file, such as standard input; it needs ``input_format``."""
    unit: str = ""
    """Of the coordinates: a label."""
    parts: str | None = None
    """Of a scene: what its parts are, as for ``detect``."""
    part: int | None = None
    """Which of them is worked on."""
    outputs: tuple[Path, ...] = ()
    """The files to write, each in the format of its suffix, and PNGs to draw."""

    @property
    def suffix(self) -> str:
        """Of the format that the file is read in."""
        return suffix_of(self.file) if self.input_format is None else f".{self.input_format}"

    @property
    def settings(self) -> str:
        """What the record depends on beside the file, such as 'asymmetry max_angle=45.0': the
        operation, and what was chosen otherwise than it is by default."""
        chosen = {
            each.name: getattr(self, each.name)
            for each in fields(self)
            if each.name not in _NO_SETTINGS and getattr(self, each.name) != each.default
        }
        words = sorted((chosen | self.parameters).items())
        return " ".join([self.operation, *(f"{name}={_shown(value)}" for name, value in words)])


def of_parts(task: FileTask, parts: str) -> list[FileTask]:
    """One task per part; the task itself where the file cannot be read, to report it."""
    try:
        scene = _parts(_shape(task), replace(task, parts=parts))
    except (InvalidInput, OSError, MemoryError):
        return [task]
    return [replace(task, parts=parts, part=number) for number in range(len(scene))]


class _Content(BytesIO):
    """An open file that errors name."""

    def __init__(self, content: bytes, name: str) -> None:
        super().__init__(content)
        self.name = name


def perform(task: FileTask, progress: Progress | None = None) -> Record:
    """Does the task. What is wrong with the file is in the record; what is wrong with the
    parameters is raised."""
    started = time.perf_counter()
    record = _head(task)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)  # the record has it
            _perform(task, record, progress)
    except (InvalidParameter, ImportError):
        raise
    except (InvalidInput, OSError, MemoryError) as error:
        record["error"] = _one_line(task.file, error)
    except Exception as error:  # noqa: BLE001 - nobody foresaw it, and other files are not to be lost
        record["error"] = _one_line(task.file, Exception(f"{type(error).__name__}: {error}"))
    record["seconds_in_all"] = time.perf_counter() - started
    return record


def failed(task: FileTask, reason: str) -> Record:
    """The record of a task that nobody could finish."""
    return _head(task) | {"error": f"{task.file}: {reason}", "seconds_in_all": math.nan}


def _head(task: FileTask) -> Record:
    return {
        "file": str(task.file),
        "operation": task.operation,
        "unit": task.unit,
        "settings": task.settings,
    }


def _perform(task: FileTask, record: Record, progress: Progress | None) -> None:
    notices: list[str] = []
    record["notices"] = notices
    if _is_read_in_chunks(task):
        _detect_in_chunks(task, record, progress)
        return
    shape = _shape(task)
    if task.parts is not None and task.part is not None:
        shape = _parts(shape, task)[task.part]
        record["part"] = task.part
    if task.downsample is not None:
        shape = _downsampled(shape, task, notices)
    if task.use_normals and shape.normals is None:
        raise InvalidInput("use_normals is given, but the file has no normals; do without")
    record["points"] = len(shape.points)
    if task.operation in analyses():
        _analyse(task, shape, record, progress)
        return
    if task.operation != DETECT and (task.mirror or task.other or not _needs_mirror(task)):
        given_mirror = mirror_record(task.mirror)
        record |= {"verdict": None, "reason": None, "mirror": given_mirror, "score": None}
        _operate(task, shape, task.mirror, record, progress)
        return
    parameters = task.parameters if task.operation == DETECT else {}
    found_at = 1 if task.operation == DETECT else FOUND_AT
    found = detect(
        shape.points,
        faces=shape.faces,
        use_faces=task.use_faces,
        normals=shape.normals if task.use_normals else None,
        weights=shape.weights,
        threads=task.threads,
        progress=share(progress, 0, found_at),
        **part(Search, task),
        **parameters,
    )
    if left_out := found.statistics.get("nonfinite_points", 0):
        notices.append(nonfinite_message(left_out))
    record |= about(found)
    if task.operation == DETECT:
        _write(task, found, record, points=shape.points)
    else:
        mirror, warning = found_mirror(found, task.require_found)
        if warning:
            notices.append(warning)
        record.pop("candidates")
        over = found if "repeat" in task.parameters else mirror
        _operate(task, shape, over, record, share(progress, found_at, 1))


def _shape(task: FileTask) -> Shape:
    given = task.file if task.content is None else _Content(task.content, str(task.file))
    return read(given, task.input_format, **part(Reading, task))


def _parts(shape: Shape, task: FileTask) -> list[Shape]:
    assert task.parts is not None
    labels = task.parts if task.parts == CONNECTED else named_array(task.file, task.parts)
    return parts_of(shape, labels)


def _is_read_in_chunks(task: FileTask) -> bool:
    needs_all = {
        "an operation": task.operation != DETECT,
        "use_normals": task.use_normals,
        "downsample": task.downsample is not None,
        "parts": task.parts is not None,
        "input_format": task.input_format is not None,
        **dict.fromkeys(task.of_image(), True),
    }
    for name, is_given in needs_all.items():
        if is_given and task.in_chunks:
            raise InvalidParameter(f"in_chunks is given beside {name}; allowed is one of them")
    if task.in_chunks is not None or any(needs_all.values()):
        return bool(task.in_chunks)
    return task.content is None and _is_large(task.file)


def _is_large(file: Path) -> bool:
    """Whether it holds so many points, and can be read in chunks. Its reader says what is wrong with
    it."""
    try:
        if not is_chunked(file) or file.stat().st_size < LARGE * _LEAST_BYTES:
            return False
        return (chunks_of(file).count or 0) > LARGE
    except (InvalidInput, OSError):
        return False


def _detect_in_chunks(task: FileTask, record: Record, progress: Progress | None) -> None:
    found = detect_chunks(
        task.file,
        external_files=task.external_files,
        threads=task.threads,
        progress=progress,
        **part(Search, task),
        **task.parameters,
    )
    thinned = np.asarray(found.points)
    record["points"] = len(thinned)
    record["notices"].append(
        f"read in chunks, and {found.point_count} points thinned to {len(thinned)}"
    )
    if left_out := found.statistics.get("nonfinite_points", 0):
        record["notices"].append(nonfinite_message(left_out))
    record |= about(found)
    _write(task, found, record, points=task.file)


def _needs_mirror(task: FileTask) -> bool:
    """By that alone: ``absolute`` is none of the core's parameters."""
    return needs_mirror(
        task.operation,
        {name: task.parameters[name] for name in ("symmetry",) if name in task.parameters},
    )


def _other(task: FileTask) -> Shape | None:
    return None if task.other is None else read(task.other, **part(Reading, task))


def _analyse(task: FileTask, shape: Shape, record: Record, progress: Progress | None) -> None:
    found = analyse(
        task.operation,
        shape,
        _other(task),
        nonfinite=task.nonfinite,
        threads=task.threads,
        progress=progress,
        **task.parameters,
    )
    if left_out := found.statistics.get("nonfinite_points", 0):
        record["notices"].append(nonfinite_message(left_out))
    record |= plain(found.to_json())
    if isinstance(found, Symmetries):
        record |= {"bop": found.to_bop(points=shape.points), "isaac": found.to_isaac()}
    _write(task, found, record)


def _operate(
    task: FileTask,
    shape: Shape,
    mirror: Result | Mirror | None,
    record: Record,
    progress: Progress | None,
) -> None:
    result = operate(
        task.operation,
        shape,
        mirror,
        other=_other(task),
        require_found=task.require_found,
        nonfinite=task.nonfinite,
        threads=task.threads,
        progress=progress,
        **task.parameters,
    )
    record |= {"parameters": plain(result.parameters), "statistics": plain(result.statistics)}
    if isinstance(result, Asymmetry):
        record |= result.inspection
    if "warning" in result.statistics:
        record["notices"].append(result.statistics["warning"])
    _write(task, result, record)


def _write(
    task: FileTask,
    found: Result | OperationResult | AnalysisResult,
    record: Record,
    points: Any = None,
) -> None:
    """Raises what nobody foresaw as an error of that file, so that the next ones are done; ``read``
    does the same for what it reads."""
    record["written"] = [str(output) for output in task.outputs]
    try:
        for output in task.outputs:
            output.parent.mkdir(parents=True, exist_ok=True)
            if output.suffix == PICTURE_SUFFIX:
                found.plot(output)
            elif isinstance(found, Asymmetry) and output.suffix.lower() == PAGE_SUFFIX:
                write_whole(output, shape_page(record, found))
            elif not isinstance(found, Result):
                record["notices"] += save_shape(found, output)
            elif output.name.endswith(SUMMARY_SUFFIX):
                write_whole(output, record_bytes(record))
            elif output.name.endswith(MATCHES_SUFFIX):
                save_matches(
                    output,
                    points,
                    found,
                    external_files=task.external_files,
                    threads=task.threads,
                )
            else:
                found.save(output)
    except (InvalidInput, InvalidParameter, ImportError, OSError, MemoryError):
        raise
    except Exception as error:
        raise InvalidInput(f"it cannot be written ({type(error).__name__}: {error})") from error


def about(found: Result) -> Record:
    """What a detection says without its points."""
    pairs = {"pairs": len(found.pairs)} if found.parameters.get("pairs", True) else {}
    return {
        **pairs,
        "surface_points": len(found.surface_points),
        "median_residual": plain(distribution(found.residuals).get("p50")),
        "residual": plain(distribution(found.residuals)),
        "verdict": found.verdict,
        "reason": found.reason,
        "mirror": mirror_record(found.mirror),
    } | found.to_json()


def distribution(lengths: NDArray[np.float64]) -> dict[str, float]:
    """Mean, root mean square, percentiles and maximum; nothing of nothing."""
    if not len(lengths):
        return {}
    p50, p95 = np.percentile(lengths, (50, 95)).tolist()
    return {
        "mean": float(lengths.mean()),
        # No product: that wakes the threads of BLAS, which wait on the processors of other jobs.
        "rms": math.sqrt(float(np.square(lengths).mean())),
        "p50": p50,
        "p95": p95,
        "max": float(lengths.max()),
    }


def _downsampled(shape: Shape, task: FileTask, notices: list[str]) -> Shape:
    """The means of the points in each cell of a grid, without faces and normals."""
    assert task.downsample is not None
    points = shape.points
    if task.nonfinite == "skip":
        finite = np.isfinite(points).all(axis=1)
        if not finite.any():
            raise InvalidInput(f"0 of {len(points)} points are finite; at least 1 is needed")
        if not finite.all():
            notices.append(nonfinite_message(int(np.count_nonzero(~finite))))
            points = points[finite]
    thinned = downsample(points, math.ceil(len(points) / task.downsample))
    return Shape(thinned, space=shape.space)


def _shown(value: Any) -> str:
    return json.dumps(plain(value), default=str)


def _one_line(file: Path, error: BaseException) -> str:
    reason = str(error) or type(error).__name__
    whole = reason if str(file) in reason else f"{file}: {reason}"
    return printable(" ".join(whole.split()))
