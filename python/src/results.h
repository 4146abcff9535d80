#pragma once

#include <pybind11/pybind11.h>
#include <symsurf/detect.h>

namespace symsurf::python {

namespace py = pybind11;

/// The result as the fields of the Python class of that name. The arrays are the core's own memory
/// and keep it alive.
py::dict to_python(Result&& result);

}  // namespace symsurf::python
