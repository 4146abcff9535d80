#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <symsurf/attributes.h>
#include <symsurf/detect.h>
#include <symsurf/operations.h>

#include <memory>
#include <optional>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "point_arrays.h"
#include "values.h"

namespace symsurf::python {

namespace {

py::dict operate_fields(const std::string& name, const PointsArgument& points,
                        const FacesArgument& faces, const std::optional<const Mirror*>& mirror,
                        const std::optional<Eigen::VectorXd>& mask, const py::object& threads,
                        const py::object& progress, const py::dict& parameters,
                        const std::optional<Eigen::MatrixXd>& landmark_pairs,
                        const std::optional<PointsArgument>& other,
                        const FacesArgument& other_faces) {
  const Operation& described = operation(name);
  OperationInput input{points, view_of(faces)};
  if (mask) input.mask = *mask;
  if (landmark_pairs) input.landmark_pairs = *landmark_pairs;
  if (other) input.other = *other;
  input.other_faces = view_of(other_faces);
  const Values values = values_from(parameters, described.parameters);
  const Context context = context_from(progress, threads);
  OperationResult result =
      without_gil([&] { return operate(name, input, mirror.value_or(nullptr), values, context); });
  py::dict fields;
  fields["operation"] = described.name;
  fields["given"] = points.array;
  fields["points"] = owned_array(std::move(result.points));
  fields["faces"] = owned_array(std::move(result.faces));
  fields["point_sources"] = to_python(result.point_sources);
  fields["face_sources"] = to_python(result.face_sources);
  fields["point_parents"] = owned_array(std::move(result.point_parents));
  fields["point_shares"] = owned_array(std::move(result.point_shares));
  fields["arrays"] = to_python(result.arrays, described.arrays);
  fields["face_arrays"] = to_python(result.face_arrays, described.face_arrays);
  fields["parameters"] = to_python(result.parameters);
  fields["statistics"] = to_python(result.statistics);
  return fields;
}

using Parents = py::array_t<Index, py::array::c_style | py::array::forcecast>;

Eigen::MatrixXd column(const py::array_t<double, py::array::forcecast>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), values.size());
}

// With what it looks at.
struct HeldTransform {
  PointsArgument points;
  std::shared_ptr<const Mirror> mirror;
  AttributeTransform by;
};

HeldTransform transform_by(const std::string& operation, const PointsArgument& given,
                           const PointsArgument& made, const Parents& sources,
                           const std::optional<Parents>& parents,
                           const std::optional<Eigen::MatrixXd>& shares,
                           const std::map<std::string, py::array>& arrays,
                           const py::dict& parameters, const py::dict& statistics,
                           const std::optional<std::shared_ptr<Mirror>>& mirror) {
  OperationResult result;
  result.operation = operation;
  result.points = PointsView(made).matrix();
  result.point_sources.assign(sources.data(), sources.data() + sources.size());
  if (parents && shares) {
    result.point_parents = Eigen::Map<const AttributeTransform::Rows>(
        parents->data(), parents->shape(0), parents->shape(1));
    result.point_shares = *shares;
  }
  for (const char* name : {"partner", "origin"})
    if (const auto found = arrays.find(name); found != arrays.end())
      result.arrays[name] = column(found->second);
  result.parameters = values_from(parameters, {});
  result.statistics = values_from(statistics, {});
  const std::shared_ptr<Mirror> used = mirror.value_or(nullptr);
  return {given, used, AttributeTransform(result, given, used.get())};
}

AttributeKind kind_from(const std::string& name) {
  if (name == "vector") return AttributeKind::Vector;
  return name == "normal" ? AttributeKind::Normal : AttributeKind::Tensor;
}

void bind_attributes(py::module_& module) {
  py::class_<HeldTransform>(
      module, "AttributeTransform",
      "Takes arrays at the points of a shape to those of its image, or of an operation's result.")
      .def(py::init([](const std::shared_ptr<Mirror>& mirror, const PointsArgument& points) {
             return HeldTransform{points, mirror, AttributeTransform(*mirror, points)};
           }),
           py::arg("mirror"), py::arg("points"), "Of the image over the mirror.")
      .def_static("of_result", &transform_by, py::arg("operation"), py::arg("given"),
                  py::arg("points"), py::arg("sources"), py::arg("parents"), py::arg("shares"),
                  py::arg("arrays"), py::arg("parameters"), py::arg("statistics"),
                  py::arg("mirror"), "Of the fields of an operation's result.")
      .def_property_readonly(
          "turns", [](const HeldTransform& held) { return held.by.turns(); },
          "Whether directions change, of some points at least.")
      .def_property_readonly(
          "jacobians",
          [](const HeldTransform& held) {
            const std::vector<Matrix3>& found =
                without_gil([&]() -> const std::vector<Matrix3>& { return held.by.jacobians(); });
            py::array_t<double> rows(
                {static_cast<py::ssize_t>(found.size()), py::ssize_t{3}, py::ssize_t{3}});
            double* value = rows.mutable_data();
            for (const Matrix3& each : found)
              for (const double entry : each.reshaped<Eigen::RowMajor>()) *value++ = entry;
            return rows;
          },
          "The local Jacobians (j, 3, 3) of the map.")
      .def_property_readonly(
          "jacobian_of",
          [](const HeldTransform& held) { return owned_array(held.by.jacobian_of()); },
          "(n, k) of each point and each of its parents the row of jacobians, -1 for none.")
      .def(
          "__call__",
          [](const HeldTransform& held, const Eigen::MatrixXd& values, const std::string& kind) {
            return owned_array(without_gil(
                [&] { return AttributeTransform::Shares(held.by(values, kind_from(kind))); }));
          },
          py::arg("values"), py::arg("kind"),
          "Values (n, c) of the kind \"vector\", \"normal\" or \"tensor\" from those (k, c) of the "
          "shape's points.");
}

}  // namespace

void bind_operations(py::module_& module) {
  bind_attributes(module);
  py::class_<PointArray>(module, "PointArray",
                         "An array that an operation or an analysis gives each point.")
      .def_readonly("name", &PointArray::name)
      .def_property_readonly(
          "type", [](const PointArray& array) { return std::string(to_string(array.type)); },
          "'real', 'integer' or 'boolean'.")
      .def_readonly("components", &PointArray::components)
      .def_readonly("doc", &PointArray::doc, "One sentence, with the unit.")
      .def_readonly("is_signed", &PointArray::is_signed,
                    "Whether 0 belongs in the middle of a colour map.")
      .def_readonly("names_points", &PointArray::names_points,
                    "Whether the values are indices of points, -1 for none.")
      .def_readonly("names_faces", &PointArray::names_faces, "Likewise of faces.")
      .def("__repr__", [](const PointArray& array) { return "<PointArray " + array.name + ">"; });

  py::class_<Operation>(module, "Operation", "The description of an operation.")
      .def_readonly("name", &Operation::name)
      .def_readonly("title", &Operation::title, "For menus.")
      .def_readonly("summary", &Operation::summary, "One sentence.")
      .def_readonly("parameters", &Operation::parameters)
      .def_readonly("arrays", &Operation::arrays)
      .def_readonly("face_arrays", &Operation::face_arrays, "Likewise, one value a face.")
      .def_readonly("shown", &Operation::shown,
                    "The name of the array to colour points by; empty: none.")
      .def_readonly("moves_points", &Operation::moves_points,
                    "Whether the result's points are not those of the input.")
      .def_readonly("adds_points", &Operation::adds_points,
                    "Whether the result has points and faces behind those of the input.")
      .def_readonly("makes_shape", &Operation::makes_shape,
                    "Whether the result may have other points and faces altogether.")
      .def_readonly("takes_mask", &Operation::takes_mask)
      .def_readonly("needs_faces", &Operation::needs_faces, "Whether bare clouds are refused.")
      .def_readonly("carries_values", &Operation::carries_values,
                    "Whether points and faces stay and what the input has at its points moves.")
      .def_readonly("takes_other", &Operation::takes_other,
                    "Whether a second shape may take the place of a mirror.")
      .def_readonly("takes_any_mirror", &Operation::takes_any_mirror,
                    "Whether the mirror may be that of another thing, near or far.")
      .def("__repr__", [](const Operation& each) { return "<Operation " + each.name + ">"; });

  module.def(
      "operations",
      [] {
        py::typing::Dict<py::str, Operation> found;
        for (const Operation& each : operations())
          found[py::str(each.name)] = py::cast(each, py::return_value_policy::reference);
        return found;
      },
      "All operations by name, in the order to show them in.");
  module.def("require_found_parameter", &require_found_parameter,
             py::return_value_policy::reference,
             "What decides whether a mirror with the verdict \"none\" is used.");
  module.def(
      "needs_mirror",
      [](const std::string& name, const py::dict& parameters) {
        return needs_mirror(name, values_from(parameters, operation(name).parameters));
      },
      py::arg("name"), py::arg("parameters"),
      "Whether the operation takes a mirror with these parameters: not about an axis.");
  module.def("operate", &operate_fields, py::arg("name"), py::arg("points"), py::arg("faces"),
             py::arg("mirror"), py::arg("mask"), py::arg("threads"), py::arg("progress"),
             py::arg("parameters"), py::arg("landmark_pairs") = py::none(),
             py::arg("other") = py::none(), py::arg("other_faces") = py::none(),
             "The fields of an operation's result.");
}

}  // namespace symsurf::python
