"""What a plotter shows, as a page that turns it: vtk.js, by the viewer that trame-vtk brings."""

from __future__ import annotations

import io
import json
import math
import os
import re
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.optional import require

if TYPE_CHECKING:
    import pyvista

VIEW_ANGLE = 30.0  # degrees; vtk.js takes no other from a scene


def require_viewer() -> None:
    """Raises ImportError where a package is missing."""
    require("reports", "pyvista", "trame_vtk")


def viewer_page(plotter: pyvista.Plotter) -> str:
    """A whole HTML page with the viewer and the scene in it."""
    from trame_vtk.tools.vtksz2html import write_html

    page = io.StringIO()
    write_html(_archive(plotter), page)
    return page.getvalue()


def scripts_of(page: str) -> list[str]:
    """What stands between the tags of scripts, as a browser hashes it."""
    parts = re.findall(r"<script\b[^>]*>(.*?)</script", page, re.DOTALL | re.IGNORECASE)
    return [part.replace("\r\n", "\n") for part in parts if part]


def _archive(plotter: pyvista.Plotter) -> bytes:
    """The scene as the viewer reads it: a zip of one JSON file, the arrays in it."""
    os.environ.setdefault("VTK_MODULE_NAME", "vtkmodules")
    from trame_vtk.modules.vtk.serializers import (
        SynchronizationContext,
        extract_array_hash,
        initialize_serializers,
        reference_id,
        serialize,
    )

    _move_closer(plotter.camera)
    plotter.render()
    initialize_serializers()
    context = SynchronizationContext()
    context.set_ignore_last_dependencies(True)  # all of the scene, not what has changed
    window = plotter.render_window
    scene: dict[str, Any] = serialize(None, window, reference_id(window), context, 1)
    scene["extra"] = {
        "vtkRefId": reference_id(window),
        "centerOfRotation": plotter.center,
        "camera": reference_id(plotter.camera),
    }
    arrays = {
        entry["hash"]: entry | {"content": context.get_cached_data_array(entry["hash"])}
        for entry in extract_array_hash(scene)
    }
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("index.json", json.dumps({"scene": scene, "hashes": arrays}))
    return archive.getvalue()


def _move_closer(camera: pyvista.Camera) -> None:
    """So that the viewer's angle sees as much as the camera's own does."""
    eye, focus = np.array(camera.position), np.array(camera.focal_point)
    half, theirs = math.radians(camera.view_angle / 2), math.radians(VIEW_ANGLE / 2)
    camera.position = focus + (eye - focus) * (math.tan(half) / math.tan(theirs))
    camera.view_angle = VIEW_ANGLE
