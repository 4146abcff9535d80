#include <pybind11/stl/filesystem.h>
#include <symsurf/context.h>
#include <symsurf/io.h>

#include <filesystem>

#include "arrays.h"
#include "bindings.h"
#include "context.h"

namespace symsurf::python {

namespace {

template <typename Matrix>
py::object array_or_none(Matrix&& matrix) {
  if (matrix.rows() == 0) return py::none();
  return owned_array(std::move(matrix));
}

py::dict read_fields(const std::filesystem::path& path) {
  Shape shape;
  try {
    shape = without_gil([&] { return read(path); });
  } catch (const InvalidInput& error) {
    // It has the file's name, whose bytes need not be UTF-8.
    const auto text = py::reinterpret_steal<py::str>(PyUnicode_DecodeFSDefault(error.what()));
    PyErr_SetObject(py::module_::import("symsurf._core").attr("InvalidInput").ptr(), text.ptr());
    throw py::error_already_set();
  }
  py::dict fields;
  fields["points"] = owned_array(std::move(shape.points));
  fields["faces"] = array_or_none(std::move(shape.faces));
  fields["normals"] = array_or_none(std::move(shape.normals));
  fields["colours"] = array_or_none(std::move(shape.colours));
  fields["polygons"] = array_or_none(std::move(shape.polygons));
  return fields;
}

}  // namespace

void bind_reading(py::module_& module) {
  module.def("read", &read_fields, py::arg("path"), "The fields of symsurf.Shape.");
  module.def("memory_limit", &memory_limit, "The bytes of memory that the process may have.");
}

}  // namespace symsurf::python
