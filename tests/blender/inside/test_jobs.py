"""Computations beside the window."""

import time
import warnings

import numpy as np
import pytest
from bl_ext.user_default.symsurf.jobs import Job, part

import symsurf


def _cloud(count):
    return np.random.default_rng(0).normal(size=(count, 3))


def test_cancelled_job_ends_soon():
    points = _cloud(200_000)
    job = Job(lambda progress: symsurf.detect(points, "perpendicular", progress=progress))
    job.start()
    while not job.fraction and job.is_alive():
        time.sleep(0.01)
    job.cancel()
    asked = time.monotonic()
    job.join()
    assert time.monotonic() - asked < 2
    with pytest.raises(symsurf.Cancelled):
        job.result()


def test_job_gives_what_it_computed_and_heard():
    def work(progress):
        warnings.warn("mind")
        return symsurf.detect(_cloud(1000), "plane", progress=part(progress, 0, 0.5)).method

    job = Job(work)
    job.start()
    job.join()
    assert job.result() == "plane"
    assert job.warnings[0] == "mind" and 0 < job.fraction <= 0.5


def test_job_raises_what_the_work_raised():
    job = Job(lambda progress: symsurf.detect(np.zeros((5, 3))))
    job.run()
    with pytest.raises(symsurf.InvalidInput):
        job.result()
