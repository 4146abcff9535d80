#include <pybind11/stl.h>
#include <symsurf/detect.h>

#include <optional>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "results.h"
#include "values.h"

namespace symsurf::python {

namespace {

py::dict with_points(Result&& result, const PointsArgument& points) {
  py::dict fields = to_python(std::move(result));
  fields["points"] = points.array;
  return fields;
}

py::dict detect_fields(const PointsArgument& points, const FacesArgument& faces,
                       const py::object& method_name, const std::optional<NormalsArgument>& normals,
                       bool refuse_nonfinite, const py::object& seed, const py::object& threads,
                       const py::object& progress, const py::dict& parameters) {
  Options options;
  options.method = py::str(method_name);
  options.parameters = values_from(parameters, method(options.method).parameters);
  if (normals) options.normals = *normals;
  options.faces = view_of(faces);
  options.refuse_nonfinite = refuse_nonfinite;
  options.seed = seed_from(seed);
  const Context context = context_from(progress, threads);
  return with_points(without_gil([&] { return detect(points, options, context); }), points);
}

py::dict match_fields(const PointsArgument& points, const FacesArgument& faces,
                      const Mirror& mirror, double pair_distance, double tolerance,
                      bool refuse_nonfinite, const py::object& threads,
                      const py::object& progress) {
  const Context context = context_from(progress, threads);
  return with_points(without_gil([&] {
                       return match(points, mirror, pair_distance, context, refuse_nonfinite,
                                    tolerance, view_of(faces));
                     }),
                     points);
}

double diagonal_of(const PointsArgument& points, const std::string& method_name,
                   bool refuse_nonfinite) {
  Options options;
  options.method = method_name;
  options.refuse_nonfinite = refuse_nonfinite;
  return without_gil([&] { return diagonal(points, options); });
}

}  // namespace

void bind_detection(py::module_& module) {
  module.def("detect", &detect_fields, py::arg("points"), py::arg("faces"), py::arg("method"),
             py::arg("normals"), py::arg("refuse_nonfinite"), py::arg("seed"), py::arg("threads"),
             py::arg("progress"), py::arg("parameters"), "The fields of symsurf.Result.");
  module.def("match", &match_fields, py::arg("points"), py::arg("faces"), py::arg("mirror"),
             py::arg("pair_distance"), py::arg("tolerance"), py::arg("refuse_nonfinite"),
             py::arg("threads"), py::arg("progress"), "The fields of symsurf.Result.");
  module.def("diagonal", &diagonal_of, py::arg("points"), py::arg("method"),
             py::arg("refuse_nonfinite"),
             "What detect takes parameters of the unit 'diagonal' as fractions of.");
}

}  // namespace symsurf::python
