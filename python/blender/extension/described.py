# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties, made from symsurf's descriptions of parameters."""

import math

from bpy.props import BoolProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty

_LARGEST_INTEGER = 2**31 - 1  # of Blender's properties


def label(name):
    """ "Max angle" of "max_angle"."""
    return name.replace("_", " ").capitalize()


def described_property(parameter):
    """The property that stands for a parameter; what is allowed is said behind what it means."""
    words = {
        "name": label(parameter.name),
        "description": f"{parameter.doc} Allowed: {parameter.allowed}".rstrip("."),
    }
    if parameter.type == "boolean":
        return BoolProperty(default=parameter.default, **words)
    if parameter.type == "choice":
        items = [(each, label(each), "") for each in parameter.choices]
        return EnumProperty(items=items, default=parameter.default, **words)
    if parameter.type == "direction":
        return FloatVectorProperty(default=tuple(parameter.default), subtype="XYZ", **words)
    if parameter.type == "position":
        return FloatVectorProperty(default=tuple(parameter.default), subtype="TRANSLATION", **words)
    words["min"] = parameter.minimum
    if math.isfinite(parameter.maximum):
        words["max"] = parameter.maximum
    if parameter.type == "integer":
        limits = {name: int(words.pop(name, _LARGEST_INTEGER)) for name in ("min", "max")}
        return IntProperty(default=int(parameter.default), **limits, **words)
    is_share = (parameter.minimum, parameter.maximum) == (0, 1)
    subtype = "FACTOR" if is_share else "NONE"
    return FloatProperty(default=parameter.default, subtype=subtype, precision=4, **words)


def value_of(operator, parameter, prefix=""):
    """What an operator has for a parameter, as symsurf takes it: 0.1 for the nearest 32-bit number."""
    value = getattr(operator, prefix + parameter.name)
    if parameter.type in ("direction", "position"):
        return tuple(shortest(each) for each in value)
    return shortest(value) if parameter.type == "real" else value


def shortest(value):
    """The decimal of a 32-bit number with as many digits as it has."""
    return float(f"{value:.7g}")
