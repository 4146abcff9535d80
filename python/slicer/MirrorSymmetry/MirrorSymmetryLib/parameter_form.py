"""Widgets for the parameters of a method, made from their descriptions. Needs Qt."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import qt


class ParameterForm:
    """The rows of a form, one a parameter that a panel can show: numbers, choices and booleans."""

    def __init__(self, layout: qt.QFormLayout, changed: Callable[[], None]) -> None:
        self._layout = layout
        self._changed = changed
        self._rows: dict[str, tuple[Any, Callable[[], Any]]] = {}

    def show(self, parameters: Iterable[Any], values: Mapping[str, Any]) -> None:
        """Makes the rows anew: of descriptions, with values by name in place of the defaults."""
        self._rows.clear()
        while self._layout.rowCount():
            self._layout.removeRow(0)
        for each in parameters:
            make = _WIDGETS.get(each.type)
            if make is None:
                continue
            widget, signal, read = make(each, values.get(each.name, each.default))
            widget.toolTip = f"{each.doc} Allowed: {each.allowed}."
            widget.connect(signal, lambda *_: self._changed())
            unit = f" ({each.unit})" if each.unit else ""
            self._layout.addRow(each.name.replace("_", " ").capitalize() + unit + ":", widget)
            self._rows[each.name] = each.default, read

    def values(self) -> dict[str, Any]:
        """By name, those that are not the default."""
        given = {name: (default, read()) for name, (default, read) in self._rows.items()}
        return {name: value for name, (default, value) in given.items() if value != default}


Made = tuple[Any, str, Callable[[], Any]]
"""A widget, the signal that it sends when its value changes, and how that is read."""


def _check_box(_: Any, value: bool) -> Made:
    widget = qt.QCheckBox()
    widget.checked = value
    return widget, "toggled(bool)", lambda: widget.checked


def _spin_box(parameter: Any, value: int) -> Made:
    widget = qt.QSpinBox()
    widget.setRange(int(parameter.minimum), int(min(parameter.maximum, 2**31 - 1)))
    widget.value = value
    return widget, "valueChanged(int)", lambda: widget.value


def _decimal_box(parameter: Any, value: float) -> Made:
    widget = qt.QDoubleSpinBox()
    widget.decimals = 4
    widget.singleStep = max(value / 10, 1e-3)
    widget.setRange(parameter.minimum, min(parameter.maximum, 1e9))
    widget.value = value
    return widget, "valueChanged(double)", lambda: widget.value


def _combo_box(parameter: Any, value: str) -> Made:
    widget = qt.QComboBox()
    widget.addItems(list(parameter.choices))
    widget.currentText = value
    return widget, "currentTextChanged(QString)", lambda: widget.currentText


_WIDGETS: dict[str, Callable[[Any, Any], Made]] = {
    "boolean": _check_box,
    "integer": _spin_box,
    "real": _decimal_box,
    "choice": _combo_box,
}
