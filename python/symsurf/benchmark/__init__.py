"""The benchmark of curved mirrors: cases with known mirrors, files of them, and scores of results.

``docs/curved_benchmark.md`` describes the cases, the files and the measures. ``import symsurf`` waits
for the cases alone.
"""

from .cases import SIZES, BenchmarkSample, benchmark, case_names

__all__ = ["SIZES", "BenchmarkSample", "benchmark", "case_names"]
