"""What the filters have in common: properties made from descriptions, ports, and errors that VTK's
observers hear."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, ClassVar, NamedTuple

import numpy as np
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from .._core import Cancelled, InvalidInput, InvalidParameter, Parameter
from ..base.options import Search, documentation
from .names import camel_case
from .shape import shape_of


class Property(NamedTuple):
    default: Any
    doc: str


_INPUT_TYPES = ("vtkDataObject", *3 * ["vtkPolyData"])  # shape, its mirror, the other, landmarks
THREADS = Property(0, "0 means as many as the machine has.")
IMAGE_THRESHOLD = Property(
    0.5,
    "Of an image: the points whose scalar is greater are the shape; 0.5 suits masks of 0 and 1.",
)
IMAGE_LABEL = Property(
    None,
    "Of an image that is a map of labels: the points whose scalar is this number are the shape, in "
    "place of those above image_threshold. None: those.",
)
SEED = Property(0, f"{documentation(Search)['seed']}.")
REFUSE_NONFINITE = Property(False, "Whether points that are not finite are an error, not left out.")


def described(parameters: Iterable[Parameter], prefix: str = "") -> dict[str, Property]:
    """A property for each parameter, by name."""
    return {
        prefix + each.name: Property(each.default, f"{each.doc} Allowed: {each.allowed}.")
        for each in parameters
    }


def selected(
    name: str, doc: str, descriptions: Mapping[str, Any], own: Mapping[str, Property] | None = None
) -> dict[str, Property]:
    """The property that chooses one of the descriptions, the filter's own, and those of the
    parameters of all."""
    one_of = f"{doc} One of: {', '.join(descriptions)}"
    properties = {name: Property(next(iter(descriptions)), one_of), **(own or {})}
    for each in descriptions.values():
        properties |= described(each.parameters, f"{each.name}_")
    return properties


class Algorithm(VTKPythonAlgorithmBase):
    """A filter whose input 0 is a shape, in whichever kind of data set, and that gives
    ``vtkPolyData``; what its class lists in ``_properties`` can be set, and nothing else.

    Of point sets other than ``vtkPolyData`` the surface of their cells is the shape; of an image the
    points whose scalar is greater than ``image_threshold``, or is ``image_label``: the active scalars, or those that
    ``SetInputArrayToProcess(0, 0, 0, 0, name)`` names; of a multiblock all blocks together. Where an
    output is said to be the input, it is what comes of this.
    """

    _properties: ClassVar[dict[str, Property]] = {}
    _inputs: ClassVar[dict[str, str]] = {"input_data": "The shape, where no filter makes it."}
    """The ports in their order: the name of a property and what it says."""
    _optional_inputs: ClassVar[tuple[int, ...]] = ()
    _output_count: ClassVar[int] = 1

    def __init_subclass__(cls) -> None:
        cls._properties = {
            **cls._properties,
            "image_threshold": IMAGE_THRESHOLD,
            "image_label": IMAGE_LABEL,
        }
        for name, each in cls._properties.items():
            _add_property(cls, name, each.doc)
        for port, (name, doc) in enumerate(cls._inputs.items()):
            _add_input(cls, name, port, doc)

    def __init__(self, **properties: Any) -> None:
        super().__init__(
            nInputPorts=len(self._inputs),
            inputType="vtkPolyData",
            nOutputPorts=self._output_count,
            outputType="vtkPolyData",
        )
        self._options: dict[str, Any] = {
            name: each.default for name, each in self._properties.items()
        }
        for name, value in properties.items():
            if not hasattr(getattr(type(self), name, None), "__set__"):
                raise TypeError(f"unexpected keyword argument {name!r}; {self._nearest(name)}")
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        is_made = "_options" in vars(self)  # VTK's own base class sets some attributes
        if is_made and not hasattr(self, name):
            raise AttributeError(self._no_attribute(name), name=name, obj=self)
        super().__setattr__(name, value)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(self._no_attribute(name), name=name, obj=self)

    def FillInputPortInformation(self, port: int, info: Any) -> int:
        """What a port takes; VTK calls this."""
        if port in self._optional_inputs:
            info.Set(vtkAlgorithm.INPUT_IS_OPTIONAL(), 1)
        info.Set(vtkAlgorithm.INPUT_REQUIRED_DATA_TYPE(), _INPUT_TYPES[port])
        return 1

    def SetInputData(self, data: vtkDataObject) -> None:
        """The shape, where no filter or reader makes it."""
        self.SetInputDataObject(0, data)

    def GetInput(self, port: int = 0) -> vtkDataObject | None:
        """The input at a port; None where there is none yet."""
        return self.GetInputDataObject(port, 0) if self.GetNumberOfInputConnections(port) else None

    def GetOutput(self, port: int = 0) -> vtkPolyData:
        """The output at a port."""
        return self.GetOutputDataObject(port)

    output = property(GetOutput, doc="The output at port 0.")

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        """Runs the filter; VTK calls this."""
        given = [vtkDataObject.GetData(each) for each in inputs]
        made = [vtkPolyData.GetData(outputs, port) for port in range(self._output_count)]
        try:
            scalars = self._options["image_threshold"], self._options["image_label"]
            shape = shape_of(given[0], self, *scalars)
            self._run([shape, *given[1:]], made)
        except Cancelled:
            return 1
        except (InvalidInput, InvalidParameter) as error:
            for each in made:
                each.Initialize()
            self._say("ErrorEvent", f"ERROR: {type(self).__name__}: {error}\n")
            return 0
        return 1

    def _run(self, inputs: list[Any], outputs: list[vtkPolyData]) -> None:
        """Fills the outputs in, a data set a port; of an optional input None. A subclass does it."""
        raise NotImplementedError

    def _chosen(self, selector: str, descriptions: Mapping[str, Any]) -> dict[str, Any]:
        """The parameters of the description that a property chooses."""
        name = self._options[selector]
        parameters = descriptions[name].parameters if name in descriptions else ()
        return {each.name: self._options[f"{name}_{each.name}"] for each in parameters}

    def _progress(self, fraction: float) -> bool:
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def _warn_of(self, statistics: Mapping[str, Any], consequence: str = "") -> None:
        """Of points that were left out, and of what the core warns of."""
        if count := statistics.get("nonfinite_points"):
            self._warn(f"{count} points are not finite and were left out{consequence}")
        if "warning" in statistics:
            self._warn(statistics["warning"])

    def _warn(self, message: str) -> None:
        self._say("WarningEvent", f"Warning: {type(self).__name__}: {message}\n")

    def _say(self, event: str, text: str) -> None:
        window = vtkOutputWindow.GetInstance()
        if self.HasObserver(event):
            self.InvokeEvent(event, text)
        elif event == "ErrorEvent":
            window.DisplayErrorText(text)
        else:
            window.DisplayWarningText(text)

    def _no_attribute(self, name: str) -> str:
        return f"{type(self).__name__} has no attribute {name!r}; {self._nearest(name)}"

    def _nearest(self, name: str) -> str:
        names = [*self._inputs, *self._properties]
        near = get_close_matches(name.lower(), names)
        return f"nearest: {', '.join(near)}" if near else f"allowed are {', '.join(names)}"


def _add_property(cls: type[Algorithm], name: str, doc: str) -> None:
    """As VTK wraps its classes: a setter, a getter and, as VTK has it from 9.4 on, a property."""

    def set_value(self: Algorithm, *value: Any) -> None:
        new = value[0] if len(value) == 1 else value
        if not np.array_equal(self._options[name], new):
            self._options[name] = new
            self.Modified()

    def get_value(self: Algorithm) -> Any:
        return self._options[name]

    set_value.__name__, get_value.__name__ = f"Set{camel_case(name)}", f"Get{camel_case(name)}"
    set_value.__doc__ = get_value.__doc__ = doc
    for accessor in (set_value, get_value):
        setattr(cls, accessor.__name__, accessor)
    setattr(cls, name, property(get_value, set_value, doc=doc))


def _add_input(cls: type[Algorithm], name: str, port: int, doc: str) -> None:
    def set_data(self: Algorithm, data: vtkDataObject) -> None:
        self.SetInputDataObject(port, data)

    def get_data(self: Algorithm) -> vtkDataObject | None:
        return self.GetInput(port)

    setattr(cls, name, property(get_data, set_data, doc=doc))
