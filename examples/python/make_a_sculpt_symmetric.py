"""
Make a sculpt symmetric
=======================

A head was modelled by hand, and its sides have drifted apart. One side's shape goes to both.
"""

# sphinx_gallery_thumbnail_number = 2
import shapes

import symsurf

sculpt = shapes.dented(shapes.head(), at=(0.45, -0.55, -0.15), width=0.3, depth=0.08)
found = symsurf.detect(sculpt, method="plane")
asymmetry = symsurf.asymmetry(sculpt, found)
asymmetry.plot("before.png", camera=(0.45, -1, 0.25))

# %%
# The normal of the plane points to the positive side, where the cheek is dented: the negative side
# is the good one. ``side="average"`` takes the middle of both.

print(found.mirror.normal.round(3))
even = symsurf.symmetrize(sculpt, found, side="negative")
even.plot("after.png", camera=(0.45, -1, 0.25))

# %%
# Vertices and faces keep their order, and with them texture coordinates, weights and colours.

left = symsurf.asymmetry(even.shape, found)
print(
    f"maximum: {asymmetry.statistics['maximum']:.3f} before, {left.statistics['maximum']:.4f} after"
)

# %%
# With ``strength=0.5`` the points go half the way; a ``mask``, one number per point, says how far each
# may move.

half = symsurf.symmetrize(sculpt, found, side="negative", strength=0.5)
print(f"{symsurf.asymmetry(half.shape, found).statistics['maximum']:.3f}")
