"""
Complete a broken bone
======================

A vertebra has lost one of its processes. The other side has it.
"""

# sphinx_gallery_thumbnail_number = 2
import shapes

import symsurf

whole = shapes.vertebra()  # in millimetres
x, y, z = whole.points.T
broken = shapes.without(whole, (x > 11) & (y > 10))

found = symsurf.detect(broken, method="plane")
found.plot("found.png", camera=(0.5, 1, 1))

# %%
# Grey points have no partner: what would mirror them is lost. ``complete`` adds their images and the
# faces between them, and joins these to the rim.

completed = symsurf.complete(broken, found)
completed.plot("completed.png", camera=(0.5, 1, 1))

# %%
# What was there is untouched; ``patch`` is what was added, a shape of its own to print or to plan
# with.

print(completed.shape)
print(completed.patch)
lost = whole.points[(x > 11) & (y > 10)]
print("lost up to x =", lost[:, 0].max().round(1), "mm")
print("restored up to", completed.patch.points[:, 0].max().round(1), "mm")
