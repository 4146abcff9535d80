#include <pybind11/stl/filesystem.h>
#include <symsurf/read.h>

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
  Shape shape = without_gil([&] { return read(path); });
  py::dict fields;
  fields["points"] = owned_array(std::move(shape.points));
  fields["faces"] = array_or_none(std::move(shape.faces));
  fields["normals"] = array_or_none(std::move(shape.normals));
  return fields;
}

}  // namespace

void bind_reading(py::module_& module) {
  module.def("read", &read_fields, py::arg("path"), "The fields of symsurf.Shape.");
}

}  // namespace symsurf::python
