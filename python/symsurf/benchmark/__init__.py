"""The benchmark of curved mirrors: cases with known mirrors, files of them, and scores of results.

``docs/curved_benchmark.md`` describes the cases, the files and the measures.
"""

from .answers import Answer, answer_in
from .cases import SIZES, BenchmarkSample, benchmark, case_names
from .files import read_benchmark, write_benchmark
from .scores import Figures, figures_of, summary

__all__ = [
    "SIZES",
    "Answer",
    "BenchmarkSample",
    "Figures",
    "answer_in",
    "benchmark",
    "case_names",
    "figures_of",
    "read_benchmark",
    "summary",
    "write_benchmark",
]
