"""The documentation site's configuration; .ci/docs builds it."""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILD = Path(os.environ["SYMSURF_DOCS_BUILD"])
sys.path[:0] = [str(HERE / "extensions"), str(HERE)]

import pictures_of_examples

import symsurf

project = "symsurf"
author = "The symsurf authors"
copyright = "The symsurf authors, BSD 3-Clause"
release = version = symsurf.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "breathe",
    "from_descriptions",
    "internal_links",
]
nitpicky = True
# What other projects document. Nothing is downloaded while the site is built, so no inventories.
nitpick_ignore_regex = [
    (
        "py:.*",
        r"(np|numpy|NDArray|ArrayLike|Progress|Kind_co|symsurf.results.result.Kind_co|pyvista|vtk|vtkmodules|os|collections|argparse)\b.*",
    ),
    (
        "py:.*",
        r"(Any|Callable|Path|pathlib|Plotter|Self|T|typing|SupportsInt|SupportsFloat|Buffer)\b.*",
    ),
    ("py:.*", r"(Iterable|Sequence|Executor|concurrent|ValueError|RuntimeError|UserWarning)\b.*"),
    ("cpp:identifier", r"(std|Eigen|vtk\w*|VTK\w*|ostream)(::.*)?"),
    ("cpp:identifier", r"(Vector3|Matrix3)::.*|Report|Motion|HeightInterpolant|Blend|Grid|Target"),
]

# Markdown: links to headings as a repository's web page makes them.
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_class_signature = "separated"
autodoc_type_aliases = {name: name for name in ("ArrayLike", "Progress")}
maximum_signature_line_length = 88
napoleon_numpy_docstring = False

# The examples run whenever the site is built; an error in one fails it.
sphinx_gallery_conf = {
    "examples_dirs": [str(HERE.parent / "examples" / "python")],
    "gallery_dirs": ["how_to"],
    "filename_pattern": r"/",
    "ignore_pattern": r"^shapes\.py",
    "image_scrapers": (pictures_of_examples.scraper,),
    "reset_modules": (),
    "run_stale_examples": True,
    "capture_repr": (),
    "remove_config_comments": True,
    "download_all_examples": False,
    "show_signature": False,
    "show_memory": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,
    "copyfile_regex": r"(index\.rst|shapes\.py)",
}

breathe_projects = {"symsurf": str(BUILD / "doxygen" / "xml")}
breathe_default_project = "symsurf"
breathe_default_members = ("members",)
breathe_domain_by_extension = {"h": "cpp"}
breathe_show_include = False

exclude_patterns = ["images", "pictures", "static", "extensions"]
suppress_warnings = [
    "config.cache",  # the scraper is a function, which Sphinx cannot pickle
    "duplicate_declaration.cpp",  # the namespace, in every header
]

html_theme = "furo"
html_title = f"symsurf {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#1f5fa8", "color-brand-content": "#1f5fa8"},
    "dark_css_variables": {"color-brand-primary": "#7fb2ee", "color-brand-content": "#7fb2ee"},
}
pygments_style = "friendly"
pygments_dark_style = "monokai"
