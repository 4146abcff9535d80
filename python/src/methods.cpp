#include <pybind11/stl.h>
#include <symsurf/detect.h>
#include <symsurf/placement.h>

#include <optional>
#include <string>
#include <utility>

#include "bindings.h"
#include "values.h"

namespace symsurf::python {

void bind_methods(py::module_& module) {
  py::class_<Parameter>(module, "Parameter", "The description of one parameter of a method.")
      .def_readonly("name", &Parameter::name)
      .def_property_readonly(
          "type", [](const Parameter& p) { return std::string(to_string(p.type)); },
          "'boolean', 'integer', 'real', 'choice', 'direction' or 'position'.")
      .def_readonly("unit", &Parameter::unit,
                    "'diagonal' (a fraction of the bounding box's), 'points', 'degrees' or ''.")
      .def_property_readonly(
          "default", [](const Parameter& p) { return to_python(p.default_value); },
          "In the parameter's type; a direction or position of (0, 0, 0) means: not given.")
      .def_property_readonly("range", &Parameter::range, "What is allowed, as text.")
      .def_property_readonly("allowed", &Parameter::allowed,
                             "The range with its unit: '[0, 1] of the diagonal'.")
      .def_readonly("minimum", &Parameter::minimum, "Least value allowed; numbers only.")
      .def_readonly("maximum", &Parameter::maximum, "Greatest value allowed; numbers only.")
      .def_readonly("choices", &Parameter::choices, "What is allowed; choices only.")
      .def_readonly("doc", &Parameter::doc, "One sentence.")
      .def_property_readonly(
          "condition",
          [](const Parameter& p) -> std::optional<std::pair<std::string, std::string>> {
            const Placement& place = placement(p.name);
            if (place.condition.empty()) return {};
            return std::pair(std::string(place.condition), std::string(place.value));
          },
          "Another parameter and its value with which alone this one counts; None: it always does.")
      .def("__repr__", [](const Parameter& p) {
        return "<Parameter " + p.name + ": " + std::string(to_string(p.type)) + " " + p.allowed() +
               ", default " + to_string(p.default_value) + ">";
      });

  py::class_<Method>(module, "Method", "The description of one method of detection.")
      .def_readonly("name", &Method::name)
      .def_readonly("title", &Method::title, "For menus.")
      .def_readonly("summary", &Method::summary, "One sentence.")
      .def_readonly("parameters", &Method::parameters)
      .def_readonly("minimum_points", &Method::minimum_points)
      .def_readonly("automatic", &Method::automatic, "Whether 'auto' tries it.")
      .def("__repr__",
           [](const Method& m) { return "<Method " + m.name + ": " + m.summary + ">"; });

  module.def(
      "methods",
      [] {
        py::typing::Dict<py::str, Method> found;
        for (const Method& method : methods())
          found[py::str(method.name)] = py::cast(method, py::return_value_policy::reference);
        return found;
      },
      "All methods of detection by name, in the order to show them in.");
}

}  // namespace symsurf::python
