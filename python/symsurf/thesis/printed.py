"""The numbers that the thesis prints in its tables 5.1 to 5.5."""

from __future__ import annotations

Figures = tuple[float, ...]

PRINTED: dict[tuple[str, str], dict[str, Figures]] = {
    ("5.1", "separation"): {
        "experiment 1": (5.47e-8, 1.19e-7, 3.97e-8),
        "experiment 2": (4.77e-8, 1.19e-7, 3.65e-8),
        "experiment 3": (5.80e-8, 2.38e-7, 3.04e-8),
        "experiment 4": (1.04e-7, 2.38e-7, 7.55e-8),
        "experiment 5": (3.09e-8, 1.19e-7, 1.14e-8),
        # The last two columns of these stand in each other's place in the thesis.
        "experiment 6": (2.74e-8, 1.19e-7, 1.32e-8),
        "experiment 7": (1.05, 1.99, 0.88),
    },
    ("5.2", "separation_normals"): {
        "experiment 1": (0.01, 0.05, 0.01),
        "experiment 2": (0.04, 0.11, 0.03),
        "experiment 3": (0.19, 0.88, 0.14),
        "experiment 4": (0.06, 0.16, 0.05),
        "experiment 5": (0.65, 1.06, 0.57),
        "experiment 6": (1.05, 3.12, 0.85),
    },
    ("5.3", "normals_only"): {
        "experiment 1": (0.09, 1.06, 0.01),
        "experiment 2": (0.29, 1.53, 0.14),
        "experiment 3": (0.72, 2.30, 0.56),
        "experiment 4": (0.74, 1.69, 0.47),
        "experiment 5": (0.42, 0.94, 0.24),
        "experiment 6": (0.40, 2.55, 0.22),
    },
    ("5.4", "sphere_thesis"): {
        "experiment 1": (2.98e-4, 5.41e-4),
        "experiment 2": (1.24e-4, 1.98e-4),
        "experiment 3": (2.99e-5, 2.52e-5),
        "experiment 4": (9.12e-4, 6.73e-4),
        "experiment 5": (1.92e-3, 1.35e-3),
    },
    ("5.5", "separation"): {
        "noise 1": (0.30, 1.14, 0.22),
        "noise 2": (0.18, 0.86, 0.10),
        "removed part": (4.43e-8, 1.19e-7, 3.38e-8),
        "uneven 1": (2.01, 2.77, 1.99),
        "uneven 2": (1.32e-3, 4.87e-3, 9.22e-4),
        "rotation": (),
    },
    ("5.5", "separation_normals"): {
        "noise 1": (0.22, 1.09, 0.16),
        "noise 2": (0.22, 1.11, 0.15),
        "removed part": (1.12e-2, 4.93e-2, 7.97e-3),
        "uneven 1": (0.89, 1.12, 0.74),
        "uneven 2": (0.15, 1.20, 2.28e-2),
        "rotation": (),
    },
    ("5.5", "normals_only"): {
        "noise 1": (0.99, 1.57, 0.89),
        "noise 2": (0.71, 1.58, 0.47),
        "removed part": (0.36, 1.17, 0.12),
        "uneven 1": (0.87, 1.22, 0.68),
        "uneven 2": (0.59, 1.22, 0.31),
    },
    ("5.5", "sphere_thesis"): {
        "noise 1": (0.30, 5.18e-2),
        "noise 2": (0.38, 0.18),
        "removed part 1": (7.43e-5, 7.86e-5),
        "removed part 2": (0.29, 0.32),
        "uneven 1": (1.67e-4, 1.41e-4),
        "uneven 2": (2.22e-4, 2.05e-4),
    },
}
"""By table and method, then by experiment: RMSE, e_max, e_avg, of spheres e_c and e_r."""
