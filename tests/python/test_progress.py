"""Progress, cancelling, Ctrl-C, and other threads during a detection."""

from __future__ import annotations

import signal
import threading
import time

import numpy as np
import pytest
from symmetric_shapes import mirrored_surface, quick

import symsurf


@pytest.fixture(scope="module")
def points() -> np.ndarray:
    return mirrored_surface(20000, 0)[0]


@pytest.mark.parametrize("method", symsurf.methods())
def test_fractions_rise_from_0_to_1_on_the_calling_thread(method, blob):
    fractions, threads = [], set()

    def progress(fraction):
        fractions.append(fraction)
        threads.add(threading.get_ident())

    symsurf.detect(blob, method, progress=progress, **quick(method))
    assert fractions[0] == 0 and fractions[-1] == 1
    assert fractions == sorted(fractions)
    assert threads == {threading.get_ident()}


def test_false_cancels(points):
    with pytest.raises(symsurf.Cancelled):
        symsurf.detect(points, progress=lambda fraction: False)
    with pytest.raises(symsurf.Cancelled):
        symsurf.detect(points, progress=lambda fraction: np.bool_(fraction < 0.01))


@pytest.mark.parametrize("answer", [None, True, 0, "", []])
def test_other_answers_do_not(answer, blob):
    symsurf.detect_plane(blob, progress=lambda fraction: answer)


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt, SystemExit])
def test_exceptions_pass_through(error, points):
    def progress(fraction):
        raise error("from the callback")

    with pytest.raises(error, match="from the callback"):
        symsurf.detect(points, progress=progress)


@pytest.fixture
def ctrl_c():
    """Starts a clock that interrupts after so many seconds."""

    def interrupt(signum, frame):
        raise KeyboardInterrupt("Ctrl-C")

    before = signal.signal(signal.SIGALRM, interrupt)
    yield lambda seconds: signal.setitimer(signal.ITIMER_REAL, seconds)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_ctrl_c_is_heard_without_a_callback(points, ctrl_c):
    ctrl_c(0.001)
    with pytest.raises(KeyboardInterrupt, match="Ctrl-C"):
        for _ in range(1000):
            symsurf.detect_plane(points)


def test_ctrl_c_is_heard_while_a_mesh_is_made(points, ctrl_c):
    ellipsoid = symsurf.Quadric(np.diag([1.0, 2.0, 3.0]), (0, 0, 0), -1)
    began = time.perf_counter()
    ctrl_c(0.2)
    with pytest.raises(KeyboardInterrupt, match="Ctrl-C"):
        ellipsoid.mesh(points, 4096)  # minutes
    assert time.perf_counter() - began < 15


MIRROR = symsurf.Plane((1, 0, 0), 0)
ELLIPSOID = symsurf.Quadric(np.diag([1.0, 2.0, 3.0]), (0, 0, 0), -1)
CALLS = {
    "match": lambda points: symsurf.match(points, MIRROR, threads=1),
    "reflect": ELLIPSOID.reflect,
    "project": ELLIPSOID.project,
    "signed_distance": ELLIPSOID.signed_distance,
    "mesh": lambda points: ELLIPSOID.mesh(points, 64),
    "bend": lambda points: symsurf.bend(points, symsurf.Sphere((0, 0, -3), 3)),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_other_threads_run_meanwhile(call, points):
    ticks, inside = [], threading.Event()

    def tick():
        while not inside.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0)

    other = threading.Thread(target=tick)
    started = []
    other.start()
    try:
        for _ in range(5):
            began = time.perf_counter()
            call(points)
            started.append((began, time.perf_counter()))
    finally:
        inside.set()
        other.join()
    # With the GIL held throughout, no tick could fall between the start and the end of the work.
    assert any(sum(began < t < ended for t in ticks) > 2 for began, ended in started)


def test_detections_in_several_threads_agree(blob):
    expected = symsurf.detect_plane(blob)
    found = []
    workers = [
        threading.Thread(target=lambda: found.append(symsurf.detect_plane(blob))) for _ in range(4)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(found) == 4
    for result in found:
        np.testing.assert_array_equal(result.residuals, expected.residuals)
