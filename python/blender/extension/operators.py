# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators made from symsurf's descriptions: one that finds the mirror, one that finds all symmetries,
and one an operation."""

from typing import ClassVar

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, StringProperty

import symsurf

from . import applying, mirrors
from .described import described_property, label, value_of
from .jobs import Job, part
from .meshes import triangles_of, weights_of
from .values import points_of

_MODES = {"OBJECT", "PAINT_VERTEX", "PAINT_WEIGHT", "PAINT_TEXTURE"}  # where meshes are their data
_VIEWING = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM"}
_FOUND_AT = 0.6  # the share of the progress that finding the mirror takes
_STEP = 0.05  # seconds between looks at the progress


class _Operator:
    """What operators have in common: beside the window while it is there, and undone as one step."""

    bl_options: ClassVar = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        shape = context.active_object
        if shape is None or shape.type != "MESH":
            cls.poll_message_set("Make a mesh the active object")
            return False
        if context.mode not in _MODES or not shape.data.is_editable:
            cls.poll_message_set("Leave edit or sculpt mode; linked meshes cannot be changed")
            return False
        return True

    @classmethod
    def settings(cls, chosen):
        """The properties to show."""
        return list(cls.__annotations__)

    def draw(self, context):
        draw_settings(self.layout, type(self), self, context)

    def execute(self, context):
        try:
            job = Job(self.work(context))
            job.run()
            return self._finish(context, job)
        except (ValueError, symsurf.Cancelled) as error:
            return self._refuse(error)

    def invoke(self, context, event):
        try:
            self._job = Job(self.work(context))
        except ValueError as error:
            return self._refuse(error)
        self._job.start()
        self._timer = context.window_manager.event_timer_add(_STEP, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
        percent = round(100 * self._job.fraction)
        context.window_manager.progress_update(percent)
        context.workspace.status_text_set(f"{self.bl_label}: {percent} %   (Esc cancels)")
        if self._job.is_alive():
            return {"PASS_THROUGH"} if event.type in _VIEWING else {"RUNNING_MODAL"}
        self._leave(context)
        try:
            return self._finish(context, self._job)
        except (ValueError, symsurf.Cancelled) as error:
            return self._refuse(error)

    def cancel(self, context):
        """Blender calls this when a window closes or a file is opened."""
        self._job.cancel()
        self._leave(context)

    def _leave(self, context):
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _finish(self, context, job):
        outcome = job.result()
        for each in job.warnings:
            self.report({"WARNING"}, each)
        self.report({"INFO"}, self.apply(context, outcome))
        return {"FINISHED"}

    def _refuse(self, error):
        cancelled = isinstance(error, symsurf.Cancelled)
        self.report({"INFO" if cancelled else "ERROR"}, "Cancelled" if cancelled else str(error))
        return {"CANCELLED"}

    def read(self, context):
        """The active object, its mirror or None, the matrix to where that is, points, triangles."""
        context.view_layer.update()  # transforms that a script has just set
        self._shape = context.active_object
        world = mirrors.matrix_of(self._shape)
        if not np.linalg.det(world[:3, :3]) > 0:
            raise symsurf.InvalidInput(
                f"{self._shape.name} has the scale {tuple(self._shape.scale)}; allowed is one that "
                "does not mirror or flatten it: apply it first"
            )
        mirror, self._frame = mirrors.mirror_and_frame(self._shape)
        self._triangles = triangles_of(self._shape.data)
        return mirror, points_of(self._shape, self._frame), self._triangles.vertices


class _Detection(_Operator):
    """Finds the mirror of the active object, and draws it as its child"""

    bl_idname = "symsurf.detect"
    bl_label = "Detect Mirror"

    @classmethod
    def settings(cls, chosen):
        """The properties to show, of those that are chosen."""
        method = chosen.method
        described = symsurf.methods()[method].parameters
        return ["method", *(f"{method}_{each.name}" for each in described), "show_candidates"]

    def work(self, context):
        self._shape = context.active_object
        context.view_layer.update()
        self._shape.symsurf_mirror = None
        _, points, faces = self.read(context)
        method = self.method
        parameters = {
            each.name: value_of(self, each, f"{method}_")
            for each in symsurf.methods()[method].parameters
        }
        return lambda progress: symsurf.detect(
            points, method, faces=faces if len(faces) else None, progress=progress, **parameters
        )

    def apply(self, context, result):
        if result.mirror is None:
            raise symsurf.InvalidInput(f"no mirror: {result.reason or self.method + ' finds none'}")
        others = result.candidates if self.show_candidates else ()
        mirrors.draw_found(context, self._shape, result, others)
        if result.verdict != "found":
            self.report({"WARNING"}, f"No symmetry of the shape: {result.reason}")
        return f"{result.mirror.kind.capitalize()}, score {result.score:.3f}"


class _Symmetries(_Operator):
    """Finds all mirror planes and rotation axes of the active object, and draws them as its children"""

    bl_idname = "symsurf.symmetries"
    bl_label = "Find Symmetries"
    analysis = symsurf.analyses()["symmetries"]

    def work(self, context):
        context.active_object.symsurf_mirror = None
        _, points, faces = self.read(context)
        parameters = {each.name: value_of(self, each) for each in _parameters_shown(self.analysis)}
        return lambda progress: symsurf.symmetries(
            symsurf.Shape(points, faces if len(faces) else None), progress=progress, **parameters
        )

    def apply(self, context, result):
        mirrors.draw_symmetries(context, self._shape, result)
        return f"{result.group}: {len(result.planes)} planes, {len(result.axes)} axes"


class _Operation(_Operator):
    def work(self, context):
        mirror, points, faces = self.read(context)
        name, parameters = self.operation.name, self._parameters()
        applying.require_applicable(self.operation, parameters, self._shape)
        options = {"mask": self._mask()} if self.operation.takes_mask else {}
        needs = mirror is None and parameters.get("symmetry") != "axis"
        given = symsurf.Shape(points, faces if len(faces) else None)

        def run(progress):
            found = _found(given, part(progress, 0, _FOUND_AT)) if needs else mirror
            rest = part(progress, _FOUND_AT if needs else 0, 1)
            values = [None] if self.operation.carries_values else []
            operate = getattr(symsurf, name)
            return operate(*values, given, found, progress=rest, **options, **parameters)

        return run

    def apply(self, context, result):
        applying.apply(self, context, self._shape, self._frame, self._triangles, result)
        words = {name: text for name, text in result.summary.items() if "\n" not in text}
        del words["operation"]
        texts = [f"{name} {text}" for name, text in words.items()]
        return f"{self.bl_label}: {', '.join(texts[:4])}"  # what the status bar has room for

    def _parameters(self):
        return {each.name: value_of(self, each) for each in self.operation.parameters}

    def _mask(self):
        if not self.vertex_group:
            return None
        group = self._shape.vertex_groups.get(self.vertex_group)
        if group is None:
            raise symsurf.InvalidParameter(f"the object has no vertex group {self.vertex_group!r}")
        return weights_of(self._shape)[:, group.index].clip(0, 1)


def _found(shape, progress):
    """The mirror of a shape that has none yet."""
    result = symsurf.detect(shape, progress=progress)
    if result.verdict != "found":
        raise symsurf.InvalidInput(f"the shape has no mirror: {result.reason}")
    return result.mirror


def draw_settings(layout, operator, chosen, context):
    """The settings of an operator, one below the other; ``chosen`` has their values."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    for name in operator.settings(chosen):
        if name == "vertex_group":
            layout.prop_search(chosen, name, context.active_object, "vertex_groups")
        else:
            layout.prop(chosen, name)


def _detection():
    items = [(name, label(name), each.summary) for name, each in symsurf.methods().items()]
    made = {
        "method": EnumProperty(items=items, name="Method", description="How the mirror is found"),
        "show_candidates": BoolProperty(
            name="Show candidates", description="Draw the other mirrors, too"
        ),
    }
    for name, method in symsurf.methods().items():
        made |= {f"{name}_{each.name}": described_property(each) for each in method.parameters}
    members = {"__annotations__": made, "__doc__": _Detection.__doc__}
    return type("SYMSURF_OT_detect", (_Detection, bpy.types.Operator), members)


def _parameters_shown(analysis):
    """Without those that need arrays which the extension does not pass."""
    return [each for each in analysis.parameters if each.name != "texture"]


def _symmetries():
    made = {each.name: described_property(each) for each in _parameters_shown(_Symmetries.analysis)}
    members = {"__annotations__": made, "__doc__": _Symmetries.__doc__}
    return type("SYMSURF_OT_symmetries", (_Symmetries, bpy.types.Operator), members)


_CARRIED = {
    "vertex_groups": "Carry the weights of vertex groups",
    "shape_keys": "Carry shape keys, as mirrored displacements",
    "attributes": "Carry attributes of vertices, such as colours",
    "flip_names": "Carry what is named for one side to the name of the other: from arm.L to arm.R",
}


def _operation(operation):
    made = {each.name: described_property(each) for each in operation.parameters}
    if operation.takes_mask:
        made["vertex_group"] = StringProperty(
            name="Vertex group", description="Its weights say how far each vertex may move"
        )
    if operation.carries_values:
        made |= {
            name: BoolProperty(name=label(name), description=text, default=True)
            for name, text in _CARRIED.items()
        }
    if operation.name == "align":
        made["move"] = applying.MOVED
    members = {
        "__annotations__": made,
        "__doc__": operation.summary.rstrip("."),
        "operation": operation,
        "bl_idname": f"symsurf.{operation.name}",
        "bl_label": operation.title.title(),
    }
    return type(f"SYMSURF_OT_{operation.name}", (_Operation, bpy.types.Operator), members)


DETECTION = _detection()
SYMMETRIES = _symmetries()
OPERATIONS = [_operation(each) for each in symsurf.operations().values()]
CLASSES = [DETECTION, SYMMETRIES, *OPERATIONS]
