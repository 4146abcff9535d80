#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <symsurf/symmetries.h>

#include "arrays.h"
#include "bindings.h"
#include "context.h"

namespace symsurf::python {

namespace {

py::dict symmetries_fields(const PointsArgument& points, const FacesArgument& faces,
                           bool refuse_nonfinite, double minimum_score, const py::object& threads,
                           const py::object& progress) {
  SymmetryOptions options;
  options.faces = view_of(faces);
  options.refuse_nonfinite = refuse_nonfinite;
  options.minimum_score = minimum_score;
  const Context context = context_from(progress, threads);
  const Symmetries found = without_gil([&] { return find_symmetries(points, options, context); });
  py::list axes;
  for (const SymmetryAxis& axis : found.axes)
    axes.append(py::make_tuple(axis.point, axis.direction, axis.order));
  py::dict fields;
  fields["group"] = found.group;
  fields["centre"] = found.centre;
  fields["planes"] = found.planes;
  fields["axes"] = axes;
  fields["inversion"] = found.inversion;
  fields["elements"] = found.elements;
  fields["score"] = found.score;
  fields["missing"] = found.missing;
  fields["seconds"] = found.seconds;
  return fields;
}

}  // namespace

void bind_symmetries(py::module_& module) {
  module.def("find_symmetries", &symmetries_fields, py::arg("points"), py::arg("faces"),
             py::arg("refuse_nonfinite"), py::arg("minimum_score"), py::arg("threads"),
             py::arg("progress"), "The fields of symsurf.Symmetries.");
}

}  // namespace symsurf::python
