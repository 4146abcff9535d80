"""The benchmark as files: a PLY of points and one of their true images a case, and one truth."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInput
from ..base.plain import plain
from ..reading import read
from ..reading.json_records import content_of
from ..saving import write_whole
from ..saving.ply_format import shape_ply_bytes
from ..shapes import Shape
from .cases import BenchmarkSample

TRUTH = "truth.json"


def write_benchmark(
    folder: Path, samples: Iterable[BenchmarkSample], size: str, seed: int
) -> list[str]:
    """Writes ``points/NAME.ply``, ``images/NAME.ply`` and ``truth.json``; gives the names."""
    for part in ("points", "images"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    records: list[dict[str, Any]] = []
    for sample in samples:
        cloud = Shape(sample.points)
        write_whole(folder / "points" / f"{sample.name}.ply", shape_ply_bytes(cloud, {}))
        if sample.images is not None:
            images = shape_ply_bytes(
                Shape(sample.images), {"partner": sample.partners.astype(np.int32)}
            )
            write_whole(folder / "images" / f"{sample.name}.ply", images)
        records.append(_record(sample))
    truth = {"benchmark": "curved mirrors", "size": size, "seed": seed, "cases": records}
    write_whole(folder / TRUTH, (json.dumps(truth, indent=1) + "\n").encode())
    return [record["name"] for record in records]


def _record(sample: BenchmarkSample) -> dict[str, Any]:
    return {
        "name": sample.name,
        "shape": sample.shape,
        "bend": sample.bend,
        "damage": sample.damage,
        "asymmetry": sample.asymmetry,
        "points": len(sample.points),
        "diagonal": sample.diagonal,
        "mirror": {"kind": sample.kind} | plain(sample.mirror),
    }


def read_benchmark(folder: Path) -> list[BenchmarkSample]:
    """The cases of a folder that was written. Raises InvalidInput, naming the file, for a truth or
    points that are missing or broken."""
    with content_of(folder / TRUTH, "not the truth of a benchmark") as truth:
        told = [_told(record) for record in truth["cases"]]
    return [_read(folder, each) for each in told]


def _told(record: dict[str, Any]) -> dict[str, Any]:
    """What the truth says of a case."""
    mirror = dict(record["mirror"])
    return {
        **{name: record[name] for name in ("name", "shape", "bend", "damage")},
        **{name: float(record[name]) for name in ("asymmetry", "diagonal")},
        "kind": mirror.pop("kind"),
        "mirror": mirror,
    }


def _read(folder: Path, told: dict[str, Any]) -> BenchmarkSample:
    name = told["name"]
    points = read(folder / "points" / f"{name}.ply").points
    images = None if told["kind"] == "none" else read(folder / "images" / f"{name}.ply").points
    if images is not None and len(images) != len(points):
        raise InvalidInput(
            f"{folder / 'images' / f'{name}.ply'} has {len(images)} images of {len(points)} points"
        )
    return BenchmarkSample(points=points, images=images, partners=np.full(len(points), -1), **told)
