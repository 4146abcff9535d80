"""symsurf evaluate --benchmark: folders of results against the benchmark of curved mirrors."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Sequence
from pathlib import Path

from ..base.plain import plain
from ..base.printable import printable
from ..benchmark import BenchmarkSample
from ..benchmark.answers import answer_in
from ..benchmark.files import read_benchmark
from ..benchmark.scores import Figures, figures_of, summary
from ..saving import write_whole
from .terminal import say

Scored = tuple[BenchmarkSample, Figures]
GROUPS: tuple[tuple[str, Callable[[BenchmarkSample], str]], ...] = (
    ("shape", lambda sample: sample.shape),
    ("bend", lambda sample: sample.bend),
    (
        "damage",
        lambda sample: f"asymmetry-{sample.asymmetry:.0%}" if sample.asymmetry else sample.damage,
    ),
)


def scored(results: Path, samples: Sequence[BenchmarkSample]) -> list[Scored]:
    """Raises InvalidInput, naming the file, for a broken answer."""
    return [
        (sample, figures_of(sample, answer_in(results, sample.name, sample.points)))
        for sample in samples
    ]


def run(results: Sequence[Path], folder: Path, as_json: bool, table: Path | None) -> int:
    samples = read_benchmark(folder)
    rows: list[list[object]] = []
    for path in results:
        cases = scored(path, samples)
        rows += [[str(path), s.name, *(plain(value) for value in f)] for s, f in cases]
        if as_json:
            for sample, figures in cases:
                record = {"results": str(path), "case": sample.name} | figures._asdict()
                say(json.dumps(plain(record)))
        else:
            say(printable(str(path)))
            say("\n".join(_lines(cases)))
    if table is not None:
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(
            [["results", "case", *Figures._fields], *rows]
        )
        write_whole(table, text.getvalue().encode())
    return 0


def _lines(cases: Sequence[Scored]) -> list[str]:
    header = (
        f"  {'':22}{'cases':>6}{'median':>10}{'90 %':>10}{'within 1 %':>12}{'kind':>7}{'found':>7}"
    )
    lines = [header]
    mirrored = [case for case in cases if case[0].images is not None]
    if mirrored:
        lines.append(_line("with a mirror", mirrored))
    for title, group in GROUPS:
        for name in dict.fromkeys(group(sample) for sample, _ in mirrored):
            lines.append(_line(f"{title} {name}", [c for c in mirrored if group(c[0]) == name]))
    without = [case for case in cases if case[0].images is None]
    if without:
        lines.append(_line("without a mirror", without))
    return lines


def _line(title: str, cases: Sequence[Scored]) -> str:
    s = summary(figures for _, figures in cases)
    return (
        f"  {title:22}{s.cases:6}{s.median:10.2%}{s.ninetieth:10.2%}{s.within:12.0%}{s.kind:7.0%}"
        f"{s.found:7.0%}"
    )
