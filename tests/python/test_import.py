"""What `import symsurf` does not wait for."""

from __future__ import annotations

import subprocess
import sys

HEAVY = (
    "concurrent.futures", "ctypes.util", "dask", "itk", "json", "matplotlib", "meshio", "multiprocessing", "open3d",
    "pandas", "polars", "pyvista", "subprocess", "tempfile", "trame_vtk", "trimesh", "urllib.request",
    "vtkmodules",
)  # fmt: skip


def test_import_is_light():
    code = f"import symsurf, sys; print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout == "[]\n"


def test_dir_lists_what_is_imported_later():
    code = "import symsurf, sys; print(set(symsurf.__all__) - set(dir(symsurf)), 'batch' in vars(symsurf))"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout == "set() False\n"
