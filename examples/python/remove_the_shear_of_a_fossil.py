"""
Remove the shear of a fossil
============================

Rock that moved sideways has sheared the skull in it: left and right still belong to each other, but no
plane maps one onto the other. An oblique plane does, along a direction that is not its normal.
"""

import numpy as np
import shapes

import symsurf

skull = shapes.head()
sheared = symsurf.Shape(skull.points @ np.array([[1, 0.3, 0.2], [0, 1, 0], [0, 0, 1]]), skull.faces)
print(symsurf.detect(sheared, method="plane").verdict)

found = symsurf.detect(sheared, method="oblique_plane")
print(found.verdict, found.score)
print(f"sheared by {found.mirror.obliquity:.2f} degrees")

# %%
# ``straighten`` makes the direction the normal: the affine map is ``straight.matrix``.

straight = symsurf.straighten(sheared, found)
straight.plot("upright.png", camera=(0.3, 1, 0.4))
print(np.round(straight.matrix, 3))

# %%
# The mirror is then a plane, and the sides can be compared like those of any other skull. A shear or
# stretch within the plane changes no symmetry and cannot be seen in it.

asymmetry = symsurf.asymmetry(straight.shape, straight.plane)
print(f"rms asymmetry: {asymmetry.statistics['rms']:.1e}")
