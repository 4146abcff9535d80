#include "arrays.h"

#include <symsurf/context.h>

#include <string>

namespace symsurf::python {

namespace {

py::array array_from(py::handle object, const std::string& what) {
  const py::module_ numpy = py::module_::import("numpy");
  try {
    if (numpy.attr("ma").attr("is_masked")(object).cast<bool>())
      throw InvalidInput(what + " have masked rows; drop them first");
    return numpy.attr("asarray")(object);
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw;  // KeyboardInterrupt and its like
    throw InvalidInput(
        what + " cannot be read as an array: " + py::str(error.value()).cast<std::string>());
  }
}

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape")).cast<std::string>();
}

// A base-class array (E), aligned (A), in C order (C): the given one itself if it is all that.
py::object as_doubles(const py::array& array, const std::string& what) {
  if (std::string("biufO").find(array.dtype().kind()) == std::string::npos)
    throw InvalidInput(what + " are of type " + py::str(array.dtype()).cast<std::string>() +
                       "; allowed are real numbers");
  try {
    return py::module_::import("numpy").attr("require")(array, "float64", "CAE");
  } catch (py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError) && !error.matches(PyExc_TypeError)) throw;
    throw InvalidInput(
        what + " cannot be read as real numbers: " + py::str(error.value()).cast<std::string>());
  }
}

bool is_rows(py::handle object) {
  return py::isinstance<py::array>(object) || py::isinstance<py::list>(object) ||
         py::isinstance<py::tuple>(object);
}

py::module_ other_objects() { return py::module_::import("symsurf.shapes.objects"); }

}  // namespace

bool has_points(py::handle object) {
  if (is_rows(object)) return false;
  const bool is_array = py::hasattr(object, "__array__");
  if (!is_array && (py::hasattr(object, "points") || py::hasattr(object, "vertices"))) return true;
  return other_objects().attr("is_known")(object).cast<bool>();
}

py::object points_of(py::handle object) {
  if (is_rows(object)) return py::reinterpret_borrow<py::object>(object);
  return other_objects().attr("points_of")(object);
}

Rows rows_from(py::handle object, const char* what) {
  const py::array array = array_from(object, what);
  if (array.ndim() == 0)
    throw InvalidInput(std::string(what) + " are of type " +
                       py::str(py::type::of(object).attr("__name__")).cast<std::string>() +
                       "; allowed are numbers (n, 3)");
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InvalidInput(std::string(what) + " have shape " + shape_text(array) +
                       "; allowed is (n, 3)");
  return {as_doubles(array, what)};
}

VectorArgument vector_from(py::handle object) {
  const py::array array = array_from(object, "coordinates");
  if (array.ndim() != 1 || array.shape(0) != 3)
    throw InvalidInput("coordinates have shape " + shape_text(array) + "; allowed is (3,)");
  const py::array_t<double> numbers = as_doubles(array, "coordinates");
  return {Vector3(numbers.at(0), numbers.at(1), numbers.at(2))};
}

}  // namespace symsurf::python
