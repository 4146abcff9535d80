# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the mirror of a mesh in Blender, and does with it what symsurf can do.

Everything that computes is symsurf's, which comes as a wheel inside the extension. Operators and panels
are made from its descriptions, so that they have what it has.
"""

import bpy

from . import mirrors, operators, panel

_CLASSES = [*operators.CLASSES, *panel.CLASSES]


def register():
    """Blender calls this when the extension is switched on."""
    for each in _CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Object.symsurf_mirror = bpy.props.PointerProperty(
        type=bpy.types.Object,
        name="Mirror",
        description="What the operations take for the mirror of this object: an object that Detect "
        "Mirror has drawn, or any other, whose plane is the one across its local Z axis. Empty: "
        "each operation finds the mirror first",
        poll=lambda shape, other: other != shape and mirrors.serves(other),
    )


def unregister():
    """Blender calls this when it is switched off."""
    del bpy.types.Object.symsurf_mirror
    for each in reversed(_CLASSES):
        bpy.utils.unregister_class(each)
