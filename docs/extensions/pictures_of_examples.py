"""Puts the pictures that an example writes behind the block that wrote them."""

import shutil
from pathlib import Path
from typing import Any

from sphinx_gallery.scrapers import figure_rst


def scraper(block: tuple, variables: dict[str, Any], gallery: dict[str, Any]) -> str:
    """Of sphinx-gallery: the PNG files beside the example, moved to where the page finds them."""
    taken = []
    for picture in sorted(Path(variables["src_file"]).parent.glob("*.png")):
        destination = variables["image_path_iterator"].next()
        shutil.move(picture, destination)
        taken.append(destination)
    return figure_rst(taken, gallery["src_dir"])
