#pragma once

#include <pybind11/pybind11.h>
#include <symsurf/parameter.h>

#include <cstdint>
#include <vector>

namespace symsurf::python {

namespace py = pybind11;

/// bool, int, float, str or a NumPy array.
py::object to_python(const Value& value);
py::dict to_python(const Values& values);

/// Keyword arguments as the core takes them. The core checks names and ranges; what is no value at
/// all (None, a file, ...) is refused here, with InvalidParameter saying what `described` allows.
Values values_from(const py::dict& arguments, const std::vector<Parameter>& described);

/// Throws InvalidParameter unless it is a whole number in [0, maximum].
std::uint64_t whole_number(py::handle object, const char* name, std::uint64_t maximum);
std::uint64_t seed_from(py::handle object);

}  // namespace symsurf::python
