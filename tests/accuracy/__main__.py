"""``python -m accuracy``: runs the cases over seeds and prints the table."""

from __future__ import annotations

import argparse
import os
import time
from concurrent.futures import ProcessPoolExecutor
from itertools import chain

from . import (
    bodies,
    cad_planes,
    candidates,
    curved,
    deformed,
    embedding,
    exact,
    given_surfaces,
    halves,
    helical,
    homologous,
    intrinsic,
    judged_bends,
    judged_scores,
    judged_verdicts,
    kinds,
    light,
    nearly_symmetric,
    operations,
    pairs,
    partial,
    planes,
    point_groups,
    pots,
    recurring,
    scores,
    sheared,
    single_kinds,
    spheres,
    symmetries,
    textures,
    toleranced,
    topology,
    without_mirror,
)
from .case import Case, Figures
from .solids import FOLDER, lacking
from .table import COLUMNS, line, rows

MODULES = (bodies, curved, deformed, embedding, kinds, planes, nearly_symmetric, cad_planes, candidates, exact,
           given_surfaces, halves, helical, homologous, intrinsic, judged_bends, judged_scores, judged_verdicts, light, operations, pairs, partial, point_groups,
           pots, recurring, scores, sheared, single_kinds, spheres, symmetries, textures, toleranced, topology,
           without_mirror)  # fmt: skip
CASES = {case.name: case for module in MODULES for case in module.CASES}

FRACTION = 5
"""One of so many trials is run by default: all cases in a quarter of an hour on two cores."""


def _seeds(case: Case, options: argparse.Namespace) -> range:
    fraction = 1 if options.all else FRACTION
    count = options.seeds or -(-case.trials // fraction)
    return range(options.first_seed, options.first_seed + count)


def _trial(task: tuple[str, str, int]) -> Figures:
    name, subject, seed = task
    return CASES[name].trial(subject, seed)


def main() -> None:
    parser = argparse.ArgumentParser(prog="accuracy", description=__doc__)
    parser.add_argument("--cases", nargs="+", default=[""], metavar="TEXT",
                        help="cases whose name contains one of these")  # fmt: skip
    parser.add_argument("--subjects", nargs="+", default=[""], metavar="TEXT",
                        help="shapes whose name contains one of these")  # fmt: skip
    parser.add_argument("--seeds", type=int,
                        help=f"trials a shape; without it a {FRACTION}th of --all")  # fmt: skip
    parser.add_argument("--all", action="store_true", help="all trials that figures should rest on")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    parser.add_argument("--by-subject", action="store_true", help="a row for each shape too")
    parser.add_argument("--list", action="store_true", help="name the cases and their shapes")
    options = parser.parse_args()

    chosen = [c for c in CASES.values() if any(text in c.name for text in options.cases)]
    if options.list:
        for case in chosen:
            print(f"{case.name}: {', '.join(case.subjects)}")
        return
    left_out = {s: lacking(s) for case in chosen for s in case.subjects if lacking(s)}
    if left_out:
        names, files = (
            ", ".join(left_out),
            ", ".join(dict.fromkeys(chain.from_iterable(left_out.values()))),
        )
        print(f"left out {names}: the folder SYMSURF_SHAPES, {FOLDER}, has no {files}")
    print(line(COLUMNS), flush=True)
    start = time.monotonic()
    with ProcessPoolExecutor(options.jobs) as pool:
        for case in chosen:
            subjects = [s for s in case.subjects if s not in left_out]
            subjects = [s for s in subjects if any(text in s for text in options.subjects)]
            seeds = _seeds(case, options)
            tasks = [(case.name, subject, seed) for subject in subjects for seed in seeds]
            trials = list(pool.map(_trial, tasks))
            if options.by_subject:
                for k, subject in enumerate(subjects):
                    own = trials[k * len(seeds) : (k + 1) * len(seeds)]
                    print(*rows(case, f"  {subject}", own), sep="\n", flush=True)
            if trials:
                print(*rows(case, case.name, trials), sep="\n", flush=True)
    print(f"{(time.monotonic() - start) / 60:.1f} minutes, {options.jobs} processes")


if __name__ == "__main__":
    main()
