"""
Mirror the pose of a character
==============================

Half a doll was modelled; it gets its other half, raises one arm, and then the other.
"""

# sphinx_gallery_thumbnail_number = 2
import shapes

import symsurf

half = shapes.half_doll()
doll = symsurf.complete(half, "x=0", search=False)
print(doll)
posed = shapes.with_an_arm_raised(doll.shape, 57)

# %%
# The image of the bent arm meets no surface any more: closest points pair only the rest of the
# doll. The triangles say which vertex mirrors which in any pose.

truth = symsurf.correspondences(doll.shape, "x=0").index
for pairing in ("closest", "topology"):
    pairs = symsurf.correspondences(posed, "x=0", pairing=pairing)
    print(f"{pairing}: {100 * (pairs.index == truth).mean():.0f} % of the vertices are right")
pairs.plot("pairs.png", camera=(0, -1, 0.1))

# %%
# Both sides get the pose of the positive one. ``side="negative"`` lets the arm down again, and
# ``side="average"`` raises both by about half.

both = symsurf.symmetrize(posed, "x=0", side="positive", pairing="topology")
both.plot("both_arms.png", camera=(0, -1, 0.1))
both.save("both_arms.ply")

# %%
# What was painted or rigged on one side goes to the other likewise, such as weights of an arm.

weights = (posed.points[:, 0] > 0.8).astype(float)
carried = symsurf.transfer(weights, posed, "x=0", pairing="topology")
print(weights.sum(), carried.values.sum())
