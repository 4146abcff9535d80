"""Pictures in the thesis's colours: yellow input, green truth, red found."""

from __future__ import annotations

from pathlib import Path

from ..plotting.drawing import new_plotter, write_picture
from .tables import Outcome

YELLOW, GREEN, RED = "#e8c100", "#1d9a3c", "#d42020"


def draw(outcome: Outcome, folder: Path) -> Path:
    """Writes the picture of one experiment and says where."""
    import pyvista

    row = outcome.row
    path = folder / f"{row.table} {row.method} {row.name}.png".replace(" ", "-")
    plotter = new_plotter(off_screen=True, window_size=(900, 700))
    plotter.add_points(outcome.points, color=YELLOW, point_size=5)
    if outcome.truth is not None:
        vertices, triangles = outcome.truth.mesh(outcome.points, 48)
        truth = pyvista.PolyData.from_regular_faces(vertices, triangles)
        plotter.add_mesh(truth, color=GREEN, opacity=0.45)
    if len(outcome.result.surface_points):
        plotter.add_points(outcome.result.surface_points, color=RED, point_size=6)
    plotter.view_vector((1, -1.6, 0.9))
    write_picture(plotter, path)
    return path
