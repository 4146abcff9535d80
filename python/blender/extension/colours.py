# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers as colours of vertices."""

import numpy as np

_SIGNED = ((0.23, 0.30, 0.75), (0.87, 0.87, 0.87), (0.71, 0.02, 0.15))  # cool to warm
_PLAIN = ((0.20, 0.22, 0.60), (0.13, 0.66, 0.52), (0.99, 0.90, 0.15))
_NONE = (0.35, 0.35, 0.35)  # for what has no value
_QUANTILE = 0.98  # what colours end at: a few outliers do not take them all


def colours_of(values, is_signed, least):
    """(n, 4) linear colours, which end where most of the values do, at ``least`` or beyond."""
    known = np.isfinite(values)
    end = np.quantile(np.abs(values[known]), _QUANTILE) if known.any() else 0.0
    end = max(end, least) or 1.0
    place = np.where(known, values, 0) / end
    place = (place.clip(-1, 1) + 1) / 2 if is_signed else place.clip(0, 1)
    stops = np.array(_SIGNED if is_signed else _PLAIN)
    made = np.ones((len(values), 4))
    for channel in range(3):
        made[:, channel] = np.interp(place, (0, 0.5, 1), stops[:, channel])
    made[~known, :3] = _NONE
    return made
