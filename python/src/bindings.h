#pragma once

#include <pybind11/pybind11.h>

// Each part of the module, in the order module.cpp adds them.

namespace symsurf::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_methods(py::module_& module);
void bind_mirrors(py::module_& module);
void bind_optics(py::module_& module);
void bind_detection(py::module_& module);
void bind_sampling(py::module_& module);
void bind_summary(py::module_& module);
void bind_reading(py::module_& module);
void bind_synthesis(py::module_& module);
void bind_benchmark(py::module_& module);
void bind_metrics(py::module_& module);
void bind_operations(py::module_& module);
void bind_analyses(py::module_& module);

}  // namespace symsurf::python
