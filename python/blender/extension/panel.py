# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab Symmetry in the sidebar of the 3D view."""

from typing import ClassVar

import bpy

import symsurf

from . import mirrors
from .operators import DETECTION, OPERATIONS, SYMMETRIES, draw_settings


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Symmetry"


class SYMSURF_PT_mirror(_Panel, bpy.types.Panel):
    """The mirror of the active object."""

    bl_label = "Mirror"

    def draw(self, context):
        layout, shape = self.layout, context.active_object
        layout.operator(DETECTION.bl_idname, icon="MOD_MIRROR")
        if shape is None or shape.type != "MESH":
            layout.label(text="Make a mesh the active object", icon="INFO")
            return
        layout.prop(shape, "symsurf_mirror")
        drawn = shape.symsurf_mirror
        text = "Each operation finds it first" if drawn is None else mirrors.text_of(drawn)
        layout.label(text=text, icon="INFO")


class _Settings(_Panel):
    """An operator, with what it will run with next."""

    bl_options: ClassVar = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context):
        self.layout.operator(self.operator.bl_idname, text="", icon="PLAY", emboss=False)

    def draw(self, context):
        layout = self.layout
        layout.operator(self.operator.bl_idname)
        last = context.window_manager.operator_properties_last(self.operator.bl_idname)
        draw_settings(layout, self.operator, last, context)


def _panel(operator, label, parent=None):
    members = {"bl_label": label, "operator": operator, "__doc__": operator.__doc__}
    if parent:
        members["bl_parent_id"] = parent
    name = operator.__name__.replace("_OT_", "_PT_")
    return type(name, (_Settings, bpy.types.Panel), members)


CLASSES = [
    SYMSURF_PT_mirror,
    _panel(DETECTION, "Detection", "SYMSURF_PT_mirror"),
    _panel(SYMMETRIES, "All symmetries", "SYMSURF_PT_mirror"),
    *(
        _panel(operator, symsurf.operations()[operator.operation.name].title)
        for operator in OPERATIONS
    ),
]
