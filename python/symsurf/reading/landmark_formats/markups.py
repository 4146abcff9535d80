"""3D Slicer's lists of points, .mrk.json."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..._core import InvalidInput
from ...shapes import Landmarks
from ..location import text_of

_SPACES = {"RAS": "RAS", "LPS": "LPS", "0": "RAS", "1": "LPS"}


def read(path: Path) -> list[Landmarks]:
    """Those of each list, in its own axes. A point that is not placed is missing."""
    import json  # `import symsurf` does not wait for it

    try:
        content = json.loads(text_of(path))
        return [_landmarks(each) for each in content["markups"]]
    except (KeyError, TypeError, AttributeError) as error:
        raise InvalidInput("this is no list of points of 3D Slicer") from error
    except RecursionError:
        raise InvalidInput("this is no JSON that can be read") from None


def _landmarks(markup: dict[str, Any]) -> Landmarks:
    points = markup["controlPoints"]
    positions = [_position(each) for each in points]
    names = tuple(str(each.get("label") or each.get("id") or "") for each in points)
    space = _SPACES.get(str(markup.get("coordinateSystem", "")), "")
    return Landmarks(np.array(positions).reshape(-1, 3), names if all(names) else (), space)


def _position(point: dict[str, Any]) -> list[float]:
    if point.get("positionStatus", "defined") != "defined" or point.get("position") is None:
        return [np.nan] * 3
    x, y, z = point["position"]
    return [float(x), float(y), float(z)]
