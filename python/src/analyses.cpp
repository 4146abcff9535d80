#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <symsurf/analyses.h>

#include <array>
#include <optional>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "point_arrays.h"
#include "values.h"

namespace symsurf::python {

namespace {

Points ends_of(const std::array<Vector3, 2>& segment) {
  Points ends(2, 3);
  ends << segment[0].transpose(), segment[1].transpose();
  return ends;
}

py::dict analyse_fields(const std::string& name, const PointsArgument& points,
                        const FacesArgument& faces, bool refuse_nonfinite,
                        const std::optional<Eigen::MatrixXd>& colours, const py::object& threads,
                        const py::object& progress, const py::dict& parameters,
                        const std::optional<PointsArgument>& other,
                        const FacesArgument& other_faces) {
  const Analysis& described = analysis(name);
  AnalysisOptions options;
  options.parameters = values_from(parameters, described.parameters);
  options.faces = view_of(faces);
  options.refuse_nonfinite = refuse_nonfinite;
  if (colours) options.colours = *colours;
  if (other) options.other = *other;
  options.other_faces = view_of(other_faces);
  const Context context = context_from(progress, threads);
  const AnalysisResult result =
      without_gil([&] { return analyse(name, points, options, context); });
  py::list axes, transformations, chain;
  for (const SymmetryAxis& axis : result.axes)
    axes.append(py::make_tuple(axis.point, axis.direction, axis.order,
                               ends_of(axis.segment(*result.footprint))));
  for (const Transformation& each : result.transformations)
    transformations.append(py::make_tuple(each.kind, each.matrix, each.score, to_python(each.from),
                                          to_python(each.onto), each.place(points)));
  for (const Symmetries& group : result.by_tolerance) {
    py::list continuous;
    for (const SymmetryAxis& axis : group.axes)
      if (axis.order == 0)
        continuous.append(py::make_tuple(axis.point, axis.direction, axis.order));
    chain.append(py::make_tuple(group.max_deviation(), group.group, group.quantile_deviation(),
                                group.elements, continuous));
  }
  py::dict fields;
  fields["points"] = points.array;
  fields["by_tolerance"] = chain;
  fields["arrays"] = to_python(result.arrays, described.arrays);
  fields["planes"] = result.planes;
  fields["axes"] = axes;
  fields["transformations"] = transformations;
  fields["parameters"] = to_python(result.parameters);
  fields["statistics"] = to_python(result.statistics);
  fields["seconds"] = result.seconds;
  return fields;
}

}  // namespace

void bind_analyses(py::module_& module) {
  py::class_<Analysis>(module, "Analysis",
                       "The description of a search for symmetries other than a single mirror.")
      .def_readonly("name", &Analysis::name)
      .def_readonly("title", &Analysis::title, "For menus.")
      .def_readonly("summary", &Analysis::summary, "One sentence.")
      .def_readonly("parameters", &Analysis::parameters)
      .def_readonly("arrays", &Analysis::arrays, "Arrays that it computes at the points.")
      .def_readonly("shown", &Analysis::shown,
                    "The name of the array to colour points by; empty: none.")
      .def_readonly("minimum_points", &Analysis::minimum_points)
      .def_readonly("takes_colours", &Analysis::takes_colours,
                    "Whether colours of the points may count.")
      .def_readonly("takes_other", &Analysis::takes_other, "Whether it needs a second shape.")
      .def_readonly("finds_elements", &Analysis::finds_elements,
                    "Whether it may give planes and axes.")
      .def_readonly("finds_transforms", &Analysis::finds_transforms,
                    "Whether it may give transformations.")
      .def("__repr__", [](const Analysis& each) { return "<Analysis " + each.name + ">"; });

  module.def(
      "analyses",
      [] {
        py::typing::Dict<py::str, Analysis> found;
        for (const Analysis& each : analyses())
          found[py::str(each.name)] = py::cast(each, py::return_value_policy::reference);
        return found;
      },
      "All analyses by name, in the order to show them in.");
  module.def("analyse", &analyse_fields, py::arg("name"), py::arg("points"), py::arg("faces"),
             py::arg("refuse_nonfinite"), py::arg("colours"), py::arg("threads"),
             py::arg("progress"), py::arg("parameters"), py::arg("other") = py::none(),
             py::arg("other_faces") = py::none(), "The fields of an analysis' result.");
}

}  // namespace symsurf::python
