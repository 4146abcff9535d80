"""``python -m ablation``: runs the cases of each mechanism with it and without, the same seeds."""

from __future__ import annotations

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import NamedTuple

import numpy as np

from .mechanisms import VARIABLE, Mechanism, build, mechanisms
from .trial import Figures, Task, trial


def _tasks(mechanism: Mechanism, seeds: int | None) -> list[Task]:
    from accuracy.__main__ import CASES
    from accuracy.solids import lacking

    return [
        (name, subject, seed)
        for name, case in CASES.items()
        if any(text in name for text in mechanism.cases)
        for subject in case.subjects
        if any(text in subject for text in mechanism.subjects) and not lacking(subject)
        for seed in range(seeds or mechanism.seeds)
    ]


class Worth(NamedTuple):
    """Of trials: how many meet their case's bars, errors over the bar, and seconds."""

    right: int
    error: float
    seconds: float


def _is_measured(figures: Figures, name: str) -> bool:
    """Seconds depend on what else runs, and have columns of their own."""
    return "second" not in name and not np.isnan(figures[name])


def _worth(tasks: list[Task], trials: list[Figures]) -> Worth:
    from accuracy.__main__ import CASES

    right, errors = 0, []
    for (name, _, _), figures in zip(tasks, trials):
        bars = {n: bar for n, bar in CASES[name].bars.items() if _is_measured(figures, n)}
        right += all(bar.met(figures[n]) for n, bar in bars.items())
        errors += [figures[n] / bar.high for n, bar in bars.items() if np.isfinite(bar.high)]
    median = float(np.median(errors)) if errors else np.nan
    return Worth(right, median, sum(figures.get("seconds", 0) for figures in trials))


def _changed(figures: Figures, others: Figures) -> bool:
    return any(figures[n] != others.get(n) for n in figures if _is_measured(figures, n))


class Runs:
    """The trials of a task, for each set of mechanisms that is off; none is run twice."""

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._done: dict[tuple[str, Task], Figures] = {}

    def __call__(self, off: str, tasks: list[Task]) -> list[Figures]:
        left = [task for task in tasks if (off, task) not in self._done]
        os.environ[VARIABLE] = off  # of processes that start afresh: the core looks once
        with ProcessPoolExecutor(self._jobs, mp_context=get_context("spawn")) as pool:
            self._done |= {(off, t): f for t, f in zip(left, pool.map(trial, left))}
        return [self._done[off, task] for task in tasks]


def main() -> None:
    parser = argparse.ArgumentParser(prog="ablation", description=__doc__)
    parser.add_argument("--mechanisms", nargs="+", default=[""], metavar="TEXT",
                        help="those whose name contains one of these")  # fmt: skip
    parser.add_argument("--together", action="store_true", help="all of them off at once, too")
    parser.add_argument("--seeds", type=int, help="trials a shape, in place of the list's")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes")
    options = parser.parse_args()
    listed = mechanisms()
    sys.path.insert(0, str(build(listed)))
    runs = Runs(options.jobs)
    chosen = [m for m in listed if m.cases and any(text in m.name for text in options.mechanisms)]
    tasks_of = {m.name: _tasks(m, options.seeds) for m in chosen}
    if options.together:
        every = list(dict.fromkeys(task for tasks in tasks_of.values() for task in tasks))
        tasks_of = {";".join(tasks_of): every} | tasks_of
    print(
        "| mechanism | trials | changed | right | without | error | without | seconds | without |"
    )
    print("|---|---|---|---|---|---|---|---|---|", flush=True)
    for off, tasks in tasks_of.items():
        before, after = runs("", tasks), runs(off, tasks)
        changed = sum(map(_changed, before, after))
        cells = [off, str(len(tasks)), str(changed)]
        for one, other in zip(_worth(tasks, before), _worth(tasks, after)):
            cells += [f"{one:.3g}", f"{other:.3g}"]
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
