"""
Straighten a bent leaf
======================

A leaf that grew in a bow is not symmetric about any plane, but about a cylinder through its midrib.
"""

import shapes

import symsurf

leaf = shapes.bent(shapes.leaf(), radius=9)
found = symsurf.detect(leaf, method="cylinder")
print(found.verdict, found.score)
print(found.mirror)

# %%
# Without ``method`` all kinds of mirror are tried, and the simplest of those that fit is taken: the
# same cylinder, in a few seconds more.
#
# ``straighten`` lays the mirror flat and takes the leaf along. Each point keeps its distance from the
# mirror.

straight = symsurf.straighten(leaf, found)
straight.plot("straight.png", camera=(0.3, 1, 0.4))

# %%
# The mirror is then a plane, over which the sides can be compared like those of any other leaf.

asymmetry = symsurf.asymmetry(straight.shape, straight.plane)
print(f"rms asymmetry: {asymmetry.statistics['rms']:.1e}")

# %%
# What was drawn or measured on the straight leaf goes back to the bent one.

back = symsurf.straighten(straight.shape, found, back=True)
print(abs(back.shape.points - leaf.points).max() < 1e-9)
