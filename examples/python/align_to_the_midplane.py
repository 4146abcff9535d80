"""
Align a scan to its mid-plane
=============================

A scan lies somewhere, turned somehow. Its mirror plane becomes x = 0, with a known up and front.
"""

import numpy as np
import shapes

import symsurf
from symsurf import synthetic

face = shapes.face_scan()
turned = symsurf.Shape(synthetic.rotate(face.points, 20, -25, 35) + (300, 100, 200), face.faces)

# %%
# The mirror says which way left and right are. What is up and in front it cannot know: rough
# directions in the scan's own axes are enough. ``frame`` says which axes they become.

up, front = synthetic.rotate(np.array([(0.1, 0.0, 1), (0.1, -1, 0.1)]), 20, -25, 35)
found = symsurf.detect(turned, method="plane")
aligned = symsurf.align(turned, found, up=up, front=front, frame="ras")
aligned.plot("aligned.png")

# %%
# The matrix moves whatever belongs to the scan, such as landmarks.

print(aligned.matrix.round(3))
landmark = turned.points[100]
print(aligned.matrix @ (*landmark, 1))
print(aligned.shape.points[100])
