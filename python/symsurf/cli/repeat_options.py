"""The options for how well a mirror repeats."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._core import make_mirror
from ..base.plain import shown
from ..batching.file_task import Record
from ..detection.repeating import Measurement, closest, deviations
from ..reading import read
from .terminal import complain, say

DEVIATIONS = ("repeats", "angle_sd", "offset_sd", "score_sd", "rms_sd")


def add_repeat(group: Any) -> None:
    group.add_argument(
        "--repeat",
        type=int,
        metavar="N",
        help="find the mirror again in N random halves of the points: report the standard deviations of "
        "its angle (degrees), offset and score, as of N measurements of the part",
    )
    group.add_argument(
        "--one-part",
        action="store_true",
        help="the files are measurements of one part, in one pose: report at the end the standard "
        "deviations of mirror, score and rms over them",
    )


def given_repeat(arguments: argparse.Namespace) -> dict[str, int]:
    repeat = getattr(arguments, "repeat", None)
    return {} if repeat is None else {"repeat": repeat}


def tell_repeatability(arguments: argparse.Namespace, records: Sequence[Record]) -> None:
    if not getattr(arguments, "one_part", False):
        return
    measured = [record for record in records if record.get("mirror") is not None]
    if len(measured) < 2:
        complain(f"one_part: {len(measured)} of {len(records)} files have a mirror; 2 are needed")
        return
    points = np.asarray(read(Path(measured[0]["file"])).points)
    first = _measurement(measured[0])
    each = [
        closest([*map(_measurement, [record, *record.get("candidates", [])])], first.mirror, points)
        for record in measured
    ]
    say("  ".join([f"{len(records)} files of one part:", *_words(deviations(each, points))]))


def _measurement(record: Record) -> Measurement:
    numbers = {name: value for name, value in record["mirror"].items() if name != "kind"}
    rms = record.get("statistics", {}).get("rms", np.nan)
    score = np.nan if record["score"] is None else record["score"]
    return Measurement(make_mirror(record["mirror"]["kind"], numbers), score, rms)


def _words(figures: dict[str, Any]) -> list[str]:
    return [f"{name} {shown(figures[name])}" for name in DEVIATIONS if name in figures]
