"""symsurf cohort: directional and fluctuating asymmetry of individuals."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .._core import InvalidParameter
from ..base.plain import plain
from ..morphometrics import Cohort, LandmarkPairs, cohort
from ..morphometrics.checks import listed
from ..morphometrics.specimens import (
    Specimens,
    closer_to_others,
    in_replicates,
    paired,
    read_pairs,
    read_specimens,
    without_odd,
)
from ..report import cohort_page, require_viewer
from ..saving import write_whole
from ..saving.cohort_format import anova_rows, individual_rows, table_bytes
from .output_paths import require_apart, require_suffix
from .terminal import complain, say
from .values import whole

SUMMARY = "Compares individuals and sides: directional and fluctuating asymmetry of a cohort."
_SUFFIXES = {"table": ".csv", "individuals": ".csv", "report": ".html"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "files",
        nargs="+",
        type=Path,
        metavar="FILE",
        help="landmarks, .mrk.json, .fcsv, .tps, .pts or .csv, of one individual per file, a TPS also of "
        "several; or meshes of one topology",
    )
    parser.add_argument(
        "--pairs",
        type=Path,
        metavar="FILE",
        help="a CSV of landmarks that mirror each other, two per row, by name or by number from 0; "
        "default: by names such as l_eye and r_eye, otherwise by the mirror found for their mean",
    )
    parser.add_argument(
        "--replicates",
        default="1",
        metavar="N",
        help="number of measurements per individual, in consecutive files; default %(default)s",
    )
    parser.add_argument("--table", type=Path, metavar="FILE", help="write the ANOVA, CSV")
    parser.add_argument(
        "--individuals", type=Path, metavar="FILE", help="write a CSV with one row per individual"
    )
    parser.add_argument(
        "--report",
        type=Path,
        metavar="FILE",
        help="write an HTML page with the ANOVA, the individuals, and mean and standard deviation of the "
        "asymmetry at each landmark, for meshes in 3D",
    )
    parser.add_argument(
        "--compare",
        metavar="NAME",
        help="the individual that the report compares with the others, by its name in the table of "
        "individuals; default: the most asymmetric",
    )
    parser.add_argument(
        "--permutations",
        default="999",
        metavar="N",
        help="number of permutations for p; default %(default)s",
    )
    parser.add_argument("--seed", default="0", metavar="N", help="random seed of the permutations")
    parser.add_argument("--json", action="store_true", help="print a JSON object")


def run(arguments: argparse.Namespace) -> int:
    outputs = _outputs(arguments)
    if "report" in outputs:
        require_viewer()
    replicates = whole(arguments.replicates)
    if not isinstance(replicates, int):
        raise InvalidParameter(f"replicates is {replicates!r}; allowed are whole numbers from 1 on")
    specimens, pairs, source = _paired(arguments)
    configurations = in_replicates(specimens.points, replicates)
    if replicates > 1:
        _warn_of_strangers(specimens, replicates)
    labels = specimens.labels[::replicates]
    compared = None if arguments.compare is None else _index_of(arguments.compare, labels)
    found = cohort(
        configurations,
        pairs,
        permutations=whole(arguments.permutations),
        seed=whole(arguments.seed),
    )
    individuals = individual_rows(found, labels)
    if compared is None:
        compared = int(np.linalg.norm(found.asymmetric, axis=(1, 2)).argmax())
    contents = {
        "table": lambda: table_bytes(anova_rows(found)),
        "individuals": lambda: table_bytes(individuals),
        "report": lambda: cohort_page(
            arguments.report.stem,
            found,
            individuals,
            compared,
            source,
            specimens.names,
            specimens.faces,
        ),
    }
    made = {path: contents[name]() for name, path in outputs.items()}
    for path, content in made.items():
        write_whole(path, content)
    say(json.dumps(_record(found, source)) if arguments.json else _text(found, source))
    return 0


def _warn_of_strangers(specimens: Specimens, replicates: int) -> None:
    others = closer_to_others(specimens, replicates)
    if others:
        one, other = others[0]
        complain(
            f"{len(others)} of {len(specimens.labels)} specimens are closer to one of another "
            f"individual than to their own replicates, as {one} to {other}: replicates are {replicates} "
            "files one behind the other"
        )


def _index_of(name: str, labels: Sequence[str]) -> int:
    if labels.count(name) != 1:
        raise InvalidParameter(
            f"compare is {name!r}, the name of {labels.count(name)} individuals; allowed is that of "
            f"one: {listed(labels)}"
        )
    return labels.index(name)


def _outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """The files to write, by option; raises what would be wrong with them before the work is done."""
    given = {name: getattr(arguments, name) for name in _SUFFIXES}
    outputs = {name: path for name, path in given.items() if path is not None}
    taken = {path.resolve() for path in (*arguments.files, arguments.pairs) if path is not None}
    for name, path in outputs.items():
        require_suffix(name, path, _SUFFIXES[name])
        require_apart(path, taken)
        taken.add(path.resolve())
        path.parent.mkdir(parents=True, exist_ok=True)
    return outputs


def _paired(arguments: argparse.Namespace) -> tuple[Specimens, LandmarkPairs, str]:
    """The specimens, without landmarks that have no counterpart, their pairs, and what told them."""
    specimens = read_specimens(arguments.files)
    if arguments.pairs is not None:
        return specimens, read_pairs(arguments.pairs, specimens), str(arguments.pairs)
    specimens, pairs, source = paired(specimens)
    rest, own = without_odd(specimens, pairs)
    if len(pairs.odd):
        odd = listed(pairs.odd_names or pairs.odd)
        complain(f"left out, as they have no counterpart: {odd}")
    return rest, own, source


def _record(found: Cohort, source: str) -> dict[str, object]:
    record = {
        "individuals": found.size.shape[0],
        "replicates": found.size.shape[1],
        "landmarks": len(found.mean),
        "pairs": len(found.pairs),
        "pairs_from": source,
        "table": found.table,
    }
    return plain(record)


def _text(found: Cohort, source: str) -> str:
    pairs = f"{len(found.pairs)}, {len(found.midline)} on the midline, by {source}"
    return f"{found}\n{'pairs':<16} {pairs}"
