"""Fuzzes symsurf from Python. Usage: python tests/fuzz/python [--first SEED] [--count N] [--log FILE]

Each call is made in a process with 2 GB and 20 s of a processor. A finding, a line of the log, is a
process that dies, an exception but the documented ones, a number that is none, and a call that takes
longer. ``--show SEED`` makes one call here, and says which."""

from __future__ import annotations

import argparse
import os
import resource
import signal
import subprocess
import sys
import time
import traceback
from collections import Counter
from pathlib import Path
from select import select

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # each asks for memory
sys.path.insert(0, str(Path(__file__).parent))

MEMORY = 2 << 30
SECONDS = 20
PATIENCE = 300  # s of waiting, for a processor that others use too


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=9000)
    parser.add_argument("--log", type=Path)
    parser.add_argument("--show", type=int)
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        return work(range(given.first, given.first + given.count))
    if given.show is not None:
        return show(given.show)
    return watch(given.first, given.first + given.count, given.log)


def watch(first: int, end: int, log: Path | None) -> int:
    """Has all seeds worked on: after one that ends the process by another."""
    findings, done = 0, Counter[str]()
    while first < end:
        command = [sys.executable, __file__, "--work", "--first", str(first), "--count"]
        with subprocess.Popen([*command, str(end - first)], stdout=subprocess.PIPE) as child:
            assert child.stdout is not None
            seed = kind = rest_of_line = ""
            while select([child.stdout], [], [], PATIENCE)[0]:
                if not (text := os.read(child.stdout.fileno(), 1 << 16).decode()):
                    break
                *lines, rest_of_line = (rest_of_line + text).split("\n")
                for line in lines:
                    what, rest = line.split(" ", 1)
                    if what == "begin":
                        seed, kind = rest.split(" ")
                    elif what == "end":
                        first, seed = int(rest) + 1, ""
                        done[kind] += 1
                    else:
                        findings += 1
                        tell(rest, log)
            else:
                child.kill()
        if seed:
            findings, first = findings + 1, int(seed) + 1
            done[kind] += 1
            reason = signal.Signals(-child.returncode).name if child.returncode < 0 else "exit"
            tell(f"seed {seed} {kind}: the process ended: {reason}", log)
        tell(f"# {dict(done)}, {findings} findings", log)
    return 1 if findings else 0


def tell(line: str, log: Path | None) -> None:
    print(line, flush=True)
    if log is not None:
        with log.open("a") as file:
            print(line, file=file)


def work(seeds: range) -> int:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    from cases import Case

    signal.signal(signal.SIGPROF, signal.SIG_DFL)  # which ends the process
    for seed in seeds:
        case = Case(seed)
        print(f"begin {seed} {case.kind}", flush=True)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        started = time.process_time()
        try:
            case.run()
        except BaseException as error:  # noqa: BLE001 - that is what is sought
            reason = f"{type(error).__name__}: {error}".replace("\n", " ")
            print(f"finding seed {seed} {case.words}: {reason}", flush=True)
        signal.setitimer(signal.ITIMER_PROF, 0)
        if (took := time.process_time() - started) > SECONDS / 4:
            print(f"finding # seed {seed} {case.words}: {took:.1f} s", flush=True)
        print(f"end {seed}", flush=True)
    return 0


def show(seed: int) -> int:
    from cases import Case

    case = Case(seed)
    started = time.process_time()
    try:
        case.run()
    except BaseException:  # noqa: BLE001
        traceback.print_exc()
    print(case.words, f"{time.process_time() - started:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
