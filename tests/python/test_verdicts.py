"""What a result says of itself, and the command line of it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from command_line import run
from symmetric_shapes import mirrored_surface

import symsurf


def test_verdicts():
    points, _ = mirrored_surface(600, 0)
    result = symsurf.detect(points, "plane")
    assert result.verdict == "found" and "plane" in result.reason
    assert symsurf.detect(points, "plane", minimum_score=1.0).verdict in ("found", "none")
    blob = np.random.default_rng(0).uniform(size=(600, 3))
    none = symsurf.detect(blob, "plane", minimum_score=0.999)
    assert none.verdict == "none" and none.reason
    matched = symsurf.match(points, result.mirror)
    assert matched.verdict == "found" and matched.reason
    assert matched.score == pytest.approx(result.score, abs=1e-9)
    unjudged = dataclasses.replace(result, statistics={})
    assert unjudged.verdict == "none" and unjudged.reason == ""
    for candidate in result.candidates:
        assert candidate.verdict in ("found", "none") and isinstance(candidate.reason, str)


def test_words():
    points, _ = mirrored_surface(600, 0)
    result = symsurf.detect(np.vstack([points, points[:1] + 0.3]), "plane")
    share = np.floor(1000 * len(result.pairs) / 601) / 10
    median = f"{np.median(result.residuals):.3g}"
    for text in (repr(result), str(result), result._repr_html_()):
        for word in ("plane", "found", f"{result.score:.3f}", f"{share:g} % of 601 points", median):
            assert word in text
    assert "\n" not in repr(result) and result.reason in str(result)
    assert "verdict" not in repr(dataclasses.replace(result, statistics={}))


def test_the_command_line_prints_the_verdict(tmp_path):
    points, _ = mirrored_surface(600, 0)
    path = tmp_path / "scan.xyz"
    np.savetxt(path, points, fmt="%.17g")
    result = symsurf.detect(points, "plane")
    done = run("detect", path, "--method", "plane")
    assert f"\n  verdict   found: {result.reason}\n" in done.stdout
