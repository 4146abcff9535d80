#include <pybind11/stl.h>
#include <symsurf/plane.h>

#include <memory>
#include <optional>

#include "arrays.h"
#include "bindings.h"
#include "values.h"

namespace symsurf::python {

namespace {

using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

// "Plane(normal=[0. 0. 1.], offset=-2.0)": the class and the numbers that define the mirror.
std::string repr(py::handle self) {
  std::string text;
  for (const auto& [name, value] : to_python(self.cast<const Mirror&>().numbers()))
    text +=
        (text.empty() ? "" : ", ") + std::string(py::str(name)) + "=" + std::string(py::str(value));
  return std::string(py::str(py::type::of(self).attr("__name__"))) + "(" + text + ")";
}

py::tuple mesh(const Mirror& mirror, const std::optional<PointsArgument>& points, int resolution) {
  Mesh found = points ? mirror.mesh(PointsView(*points), resolution) : mirror.mesh(resolution);
  return py::make_tuple(owned_array(std::move(found.vertices)),
                        owned_array(std::move(found.triangles)));
}

// A kind of mirror: its class, and its defining numbers as attributes.
template <typename Kind>
py::class_<Kind, Mirror, std::shared_ptr<Kind>> bind_kind(py::module_& module, const char* name,
                                                          const char* doc) {
  return {module, name, doc};
}

void bind_mirror(py::module_& module) {
  py::class_<Mirror, std::shared_ptr<Mirror>>(
      module, "Mirror",
      "A surface of symmetry. The image of x is x + 2 (foot(x) - x), foot(x) being the point of\n"
      "the mirror that x maps through.")
      .def_property_readonly("kind", [](const Mirror& m) { return std::string(m.kind()); })
      .def_property_readonly(
          "numbers", [](const Mirror& m) { return to_python(m.numbers()); },
          "The numbers that define the mirror, by name.")
      .def(
          "reflect",
          [](const Mirror& m, const PointsArgument& points) {
            return owned_array(m.reflect(PointsView(points)));
          },
          py::arg("points"), "The images of points (n, 3); NaN where a point has none.")
      .def(
          "project",
          [](const Mirror& m, const PointsArgument& points) {
            return owned_array(m.project(PointsView(points)));
          },
          py::arg("points"), "The feet of points (n, 3) on the mirror; NaN where there is none.")
      .def(
          "signed_distance",
          [](const Mirror& m, const PointsArgument& points) {
            return owned_array(m.signed_distance(PointsView(points)));
          },
          py::arg("points"),
          "Distances (n,) of points (n, 3) from their feet, signed by side; NaN without a foot.")
      .def("mesh", &mesh, py::arg("points") = py::none(), py::arg("resolution") = 32,
           "Triangles over the part of the mirror that lies inside an object.\n\n"
           "points: the object (n, 3); without it, the one the mirror was found in.\n"
           "resolution: cells along the longer side.\n"
           "Returns vertices (v, 3) and triangles (t, 3). Raises InvalidInput for a mirror made\n"
           "by hand when no points are given, InvalidParameter for a resolution below 1.")
      .def("__repr__", &repr);
}

}  // namespace

void bind_mirrors(py::module_& module) {
  bind_mirror(module);

  bind_kind<Plane>(module, "Plane", "The plane normal . x + offset = 0.")
      .def(py::init([](const VectorArgument& normal, double offset) {
             return std::make_shared<Plane>(normal.vector, offset);
           }),
           py::arg("normal"), py::arg("offset"))
      .def_property_readonly(
          "normal", [](const Plane& p) { return owned_array(Vector3(p.normal())); },
          "Unit normal (3,).")
      .def_property_readonly("offset", &Plane::offset, "In input units.")
      .def_property_readonly(
          "matrix", [](const Plane& p) { return owned_array(RowMajor4(p.matrix())); },
          "The reflection (4, 4) on homogeneous columns (x, y, z, 1).");
}

}  // namespace symsurf::python
