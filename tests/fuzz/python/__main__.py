"""Fuzzes symsurf from Python. Usage: python tests/fuzz/python [--files] [--first SEED] [--count N] [--points N] [--log FILE]

Each call is made in a process with 2 GB and 20 s of a processor. A finding, a line of the log, is a
process that dies, an exception but the documented ones, a number that is none, a call that takes
longer, and a kind of call that is always refused. With ``--files`` the calls read damaged files.
``--show SEED`` makes one call here, and writes its points and faces, or the bytes of its file, to
``--output``."""

from __future__ import annotations

import argparse
import os
import resource
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from select import select
from tempfile import TemporaryDirectory
from typing import Any

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # each asks for memory
sys.path.insert(0, str(Path(__file__).parent))

MEMORY = 2 << 30
SECONDS = 20
PATIENCE = 300  # s of waiting, for a processor that others use too
# A kind of call that is refused as often has no results: of those that have, most calls give one.
REFUSALS = 10


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--files", action="store_true")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=9000)
    parser.add_argument("--points", type=int, default=2000, help="at most, of each cloud")
    parser.add_argument("--log", type=Path)
    parser.add_argument("--show", type=int)
    parser.add_argument("--output", type=Path, metavar="NPZ")
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work:
        return work(range(given.first, given.first + given.count), given.points, given.files)
    if given.show is not None:
        return show(given.show, given.points, given.output, given.files)
    return watch(given.first, given.first + given.count, given.points, given.log, given.files)


def watch(first: int, end: int, points: int, log: Path | None, files: bool) -> int:
    """Has all seeds worked on: after one that ends the process by another."""
    findings, done, refused = 0, Counter[str](), Counter[str]()
    while first < end:
        seed = kind = words = ""
        with (
            TemporaryDirectory(prefix="fuzz-") as folder,
            started(range(first, end), points, files, folder) as child,
        ):
            for line in lines_of(child):
                what, rest = line.split(" ", 1)
                if what == "begin":
                    seed, kind = rest.split(" ")
                elif what == "call":
                    words = rest
                elif what == "finding":
                    findings += 1
                    tell(f"seed {seed} {kind}: {words}: {rest}", log)
                elif what == "slow":
                    tell(f"# seed {seed} {kind}: {words}: {rest}", log)
                elif what == "refused":
                    refused[kind] += 1
                else:
                    first, seed = int(rest) + 1, ""
                    done[kind] += 1
        if seed:
            findings, first = findings + 1, int(seed) + 1
            done[kind] += 1
            tell(f"seed {seed} {kind}: {words}: {end_of(child)}", log)
    for kind, many in refused.items():
        if many == done[kind] >= REFUSALS:
            findings += 1
            tell(f"{kind}: all of {many} calls are refused", log)
    tell(f"# {dict(done)}, of which {dict(refused)} are refused, {findings} findings", log)
    return 1 if findings else 0


def started(seeds: range, points: int, files: bool, folder: str) -> subprocess.Popen[bytes]:
    """A process that works on the seeds.

    Args:
        folder: of its temporary files, which no other program has: none may be left.
    """
    words = ["--work", f"--first={seeds.start}", f"--count={len(seeds)}", f"--points={points}"]
    words += ["--files"] * files
    environment = os.environ | {"TMPDIR": folder}
    return subprocess.Popen(
        [sys.executable, __file__, *words], stdout=subprocess.PIPE, env=environment
    )


def lines_of(child: subprocess.Popen[bytes]) -> Iterator[str]:
    """Until it ends, or says nothing for long."""
    assert child.stdout is not None
    rest = ""
    while select([child.stdout], [], [], PATIENCE)[0]:
        if not (text := os.read(child.stdout.fileno(), 1 << 16).decode()):
            return
        *lines, rest = (rest + text).split("\n")
        yield from lines
    child.kill()


def end_of(child: subprocess.Popen[bytes]) -> str:
    if child.returncode == -signal.SIGPROF:
        return f"more than {SECONDS} s"
    name = signal.Signals(-child.returncode).name if child.returncode < 0 else "an exit"
    return f"the process ended with {name}"


def tell(line: str, log: Path | None) -> None:
    print(line, flush=True)
    if log is not None:
        with log.open("a") as file:
            print(line, file=file)


def work(seeds: range, points: int, files: bool) -> int:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    make_case = maker(points, files)
    signal.signal(signal.SIGPROF, signal.SIG_DFL)  # which ends the process
    for seed in seeds:
        case = make_case(seed, tell=lambda words: say("call", words))
        say("begin", f"{seed} {case.kind}")
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        began = time.process_time()
        try:
            if not case.run():
                say("refused", str(seed))
        except BaseException as error:  # noqa: BLE001 - that is what is sought
            say("finding", f"{type(error).__name__}: {error}")
        signal.setitimer(signal.ITIMER_PROF, 0)
        if (took := time.process_time() - began) > SECONDS / 4:
            say("slow", f"{took:.1f} s")
        say("end", str(seed))
    return 0


def maker(points: int, files: bool) -> Any:
    """What makes a case of a seed and of what it is to be told."""
    if files:
        from files import Case as FileCase

        return FileCase
    import cases

    return partial(cases.Case, most=points)


def say(what: str, words: str) -> None:
    print(what, " ".join(words.split()), flush=True)


def show(seed: int, points: int, output: Path | None, files: bool) -> int:
    case = maker(points, files)(seed, tell=print)
    if output is not None:
        import numpy

        numpy.savez(output, points=case.points, faces=() if case.faces is None else case.faces)
    began = time.process_time()
    try:
        case.run()
    finally:
        print(f"{time.process_time() - began:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
