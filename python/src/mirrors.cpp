#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <memory>
#include <numbers>
#include <optional>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "values.h"

namespace symsurf::python {

// An object of one type, T in the stubs: pybind11's TypeVar compiles with GCC alone.
class AnyMesh : public py::object {
  PYBIND11_OBJECT_DEFAULT(AnyMesh, py::object, PyObject_Type)
  using py::object::object;
};

}  // namespace symsurf::python

template <>
struct pybind11::detail::handle_type_name<symsurf::python::AnyMesh> {
  static constexpr auto name = const_name("T");
};

namespace symsurf::python {

namespace {

using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

// "Plane(normal=(0, 0, 1), offset=-2)": the class and the numbers that define the mirror.
std::string repr(py::handle self) {
  std::string text;
  for (const auto& [name, value] : self.cast<const Mirror&>().numbers())
    text += (text.empty() ? "" : ", ") + name + "=" + to_string(value);
  return py::str(py::type::of(self).attr("__name__")).cast<std::string>() + "(" + text + ")";
}

py::tuple mesh(const Mirror& mirror, const std::optional<PointsArgument>& points, int resolution) {
  Mesh found = interruptible([&](const Context& context) {
    return mirror.mesh(points ? PointsView(*points) : mirror.footprint(), resolution, context);
  });
  return py::make_tuple(owned_array(std::move(found.vertices)),
                        owned_array(std::move(found.triangles)));
}

py::object footprint(const Mirror& mirror) {
  if (mirror.footprint().empty()) return py::none();
  return owned_array(Points(mirror.footprint().matrix()));
}

std::shared_ptr<Mirror> made(const std::string& kind, const py::dict& numbers,
                             const std::optional<PointsArgument>& footprint) {
  const Values values = values_from(numbers, {});
  const std::shared_ptr<Mirror> mirror = without_gil([&] { return make_mirror(kind, values); });
  if (footprint) mirror->set_footprint(std::make_shared<Points>(PointsView(*footprint).matrix()));
  return mirror;
}

// For pickle and copy: the arguments of make_mirror.
py::tuple reduce(const Mirror& mirror) {
  return py::make_tuple(
      py::module_::import("symsurf._core").attr("make_mirror"),
      py::make_tuple(std::string(mirror.kind()), to_python(mirror.numbers()), footprint(mirror)));
}

// Of mirrors that are equal the same: 0 and -0 are.
py::ssize_t hash(const Mirror& mirror) {
  const py::object rows = py::module_::import("numpy").attr("ravel");
  py::list parts;
  parts.append(std::string(mirror.kind()));
  for (const auto& [name, value] : mirror.numbers())
    parts.append(py::tuple(rows(to_python(value)).attr("tolist")()));
  return py::hash(py::tuple(parts));
}

void bind_mirror(py::module_& module) {
  py::class_<Mirror, std::shared_ptr<Mirror>>(
      module, "Mirror",
      "A surface of symmetry. The image of x is x + 2 (foot(x) - x), foot(x) being the point of\n"
      "the mirror that x maps through.")
      .def_property_readonly(
          "kind", [](const Mirror& m) { return std::string(m.kind()); },
          "\"plane\", \"sphere\", \"cylinder\", \"quadric\", \"height field\" (of\n"
          "fixed_direction), \"free-form\" (of perpendicular) or \"surface\" (a generator's).")
      .def_property_readonly(
          "numbers", [](const Mirror& m) { return to_python(m.numbers()); },
          "The numbers that define the mirror, by name.")
      .def(
          "reflect",
          [](const Mirror& m, const BarePointsArgument& points) {
            return owned_array(interruptible(
                [&](const Context& context) { return m.reflect(PointsView(points), context); }));
          },
          py::arg("points"), "The images of points (n, 3); NaN for points without one.")
      .def(
          "reflect",
          [](const py::object& self, const AnyMesh& mesh) -> AnyMesh {
            return py::module_::import("symsurf.reflection").attr("reflected")(mesh, self);
          },
          py::arg("mesh"),
          "The image of a Shape, or of a mesh, a cloud or a table of PyVista, trimesh, Open3D,\n"
          "ITK, meshio, pandas or polars: one of the same type with its own attributes, its faces\n"
          "turned round, so that what was outside is. Without normals, which would no longer fit.\n"
          "Of another object with points or vertices their images (n, 3). Raises InvalidInput for\n"
          "a data set whose cells are not all points, lines and flat faces.")
      .def(
          "project",
          [](const Mirror& m, const PointsArgument& points) {
            return owned_array(interruptible(
                [&](const Context& context) { return m.project(PointsView(points), context); }));
          },
          py::arg("points"), "The foot points (n, 3) of points (n, 3); NaN for points without one.")
      .def(
          "signed_distance",
          [](const Mirror& m, const PointsArgument& points) {
            return owned_array(interruptible([&](const Context& context) {
              return m.signed_distance(PointsView(points), context);
            }));
          },
          py::arg("points"),
          "Distances (n,) of points (n, 3) from their feet, signed by side; NaN without a foot.")
      .def_property_readonly("footprint", &footprint,
                             "Points (k, 3) that stand for the object in which the mirror was "
                             "found; None for a mirror\n"
                             "made by hand.")
      .def("mesh", &mesh, py::arg("points") = py::none(), py::arg("resolution") = 32,
           "Triangles over the part of the mirror that lies inside an object.\n\n"
           "points: the object (n, 3); without it, the one the mirror was found in.\n"
           "resolution: cells along the longer side.\n"
           "Returns vertices (v, 3) and triangles (t, 3). Raises InvalidInput for a mirror made\n"
           "by hand when no points are given, InvalidParameter for a resolution out of 1 to 4096.")
      .def(
          "__eq__",
          [](const Mirror& m, const py::object& other) {
            return py::isinstance<Mirror>(other) && m == other.cast<const Mirror&>();
          },
          py::arg("other"),
          "Whether the kind and all numbers are the same, to the last bit; the objects that the\n"
          "mirrors were found in may differ.")
      .def("__hash__", &hash)
      .def("__reduce__", &reduce)
      .def("__repr__", &repr);
}

// A kind of mirror: its class and its numbers as attributes. The constructor is up to the kind.
template <typename Kind>
auto bind_kind(py::module_& module, const char* name, const char* doc,
               std::initializer_list<std::pair<const char*, const char*>> numbers) {
  py::class_<Kind, Mirror, std::shared_ptr<Kind>> kind(module, name, doc);
  for (const auto& [number, about] : numbers)
    kind.def_property_readonly(
        number,
        [key = std::string(number)](const Kind& m) { return to_python(m.numbers().at(key)); },
        about);
  return kind;
}

}  // namespace

void bind_mirrors(py::module_& module) {
  bind_mirror(module);
  module.def(
      "make_mirror", &made, py::arg("kind"), py::arg("numbers"), py::arg("footprint") = py::none(),
      "The mirror of Mirror.kind and Mirror.numbers: how one comes back from a file.\n\n"
      "numbers: those that the class of the kind lists, such as {\"normal\": (3,),\n"
      "\"offset\": real} of a plane; a quadric's \"origin\", \"gradient\" and \"value\" come\n"
      "before its linear and constant terms.\n"
      "footprint: points (n, 3) that stand for the object, for Mirror.mesh.\n"
      "Raises InvalidInput for an unknown kind, or a number that is missing or of another\n"
      "type.");

  bind_kind<Plane>(module, "Plane", "The plane normal . x + offset = 0.",
                   {{"normal", "Unit normal (3,)."}, {"offset", "In input units."}})
      .def(py::init([](const VectorArgument& normal, double offset) {
             return std::make_shared<Plane>(normal.vector, offset);
           }),
           py::arg("normal"), py::arg("offset"))
      .def_property_readonly(
          "matrix", [](const Plane& p) { return owned_array(RowMajor4(p.matrix())); },
          "The reflection (4, 4) on homogeneous columns (x, y, z, 1).")
      .def_property_readonly(
          "origin", [](const Plane& p) { return owned_array(Vector3(p.origin())); },
          "The plane's point (3,) closest to the origin of the coordinates.")
      .def_property_readonly(
          "axes",
          [](const Plane& p) {
            return owned_array(Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(p.axes()));
          },
          "A right-handed frame (3, 3), a unit vector a row: two within the plane, then the\n"
          "normal. The first is orthogonal to the coordinate axis that the normal leans towards\n"
          "least; of equal ones to the first.");

  bind_kind<ObliquePlane>(
      module, "ObliquePlane",
      "The plane normal . x + offset = 0 that mirrors along a direction of its own:\n"
      "x' = x - 2 (normal . x + offset) / (normal . direction) direction.",
      {{"normal", "Unit normal (3,)."},
       {"offset", "In input units."},
       {"direction", "Unit vector (3,), to the side that the normal points to."}})
      .def(py::init(
               [](const VectorArgument& normal, double offset, const VectorArgument& direction) {
                 return std::make_shared<ObliquePlane>(normal.vector, offset, direction.vector);
               }),
           py::arg("normal"), py::arg("offset"), py::arg("direction"))
      .def_property_readonly(
          "obliquity", [](const ObliquePlane& p) { return p.obliquity() * 180 / std::numbers::pi; },
          "The angle between direction and normal, degrees, 0 to less than 90.")
      .def_property_readonly(
          "matrix", [](const ObliquePlane& p) { return owned_array(RowMajor4(p.matrix())); },
          "The reflection (4, 4) on homogeneous columns (x, y, z, 1).");

  bind_kind<Sphere>(
      module, "Sphere",
      "The sphere |x - centre| = radius. Points are mirrored along the radius, |x' - c| =\n"
      "2r - |x - c|; the centre and points farther than 2r from it have no image.",
      {{"centre", "(3,), in input units."}, {"radius", "In input units."}})
      .def(py::init([](const VectorArgument& centre, double radius) {
             return std::make_shared<Sphere>(centre.vector, radius);
           }),
           py::arg("centre"), py::arg("radius"));

  bind_kind<HeightField>(
      module, "HeightField",
      "The graph of a height over the plane orthogonal to a direction: points are mirrored along\n"
      "it. The surface passes through its nodes and goes on smoothly between and beyond them.",
      {{"direction", "Unit vector (3,)."}, {"nodes", "(m, 3), in input units."}})
      .def(py::init([](const VectorArgument& direction, const PointsArgument& nodes) {
             return interruptible([&](const Context& context) {
               return std::make_shared<HeightField>(direction.vector,
                                                    Points(PointsView(nodes).matrix()), context);
             });
           }),
           py::arg("direction"), py::arg("nodes"));

  bind_kind<FreeForm>(
      module, "FreeForm",
      "A smooth surface of any shape, mirrored perpendicularly: a blend of k quadratic\n"
      "patches. make_mirror makes one of its numbers.",
      {{"centres", "(k, 3), the origins of the patches' frames."},
       {"tangents", "(k, 3), the first axes of the frames."},
       {"normals", "(k, 3), the third axes of the frames."},
       {"heights", "(k, 6), the coefficients of the patches."},
       {"radii", "(k, 1), how far the patches reach."}});

  bind_kind<SurfaceMirror>(
      module, "SurfaceMirror",
      "A known surface z = f(x, y), placed by x -> scale * rotation @ x + translation: the truth\n"
      "of generated samples.",
      {{"surface", "'f1' to 'f6'."},
       {"mapping", "'fixed' (along the surface's z axis) or 'perpendicular'."},
       {"scale", "Input units a unit of the surface's frame."},
       {"rotation", "(3, 3)."},
       {"translation", "(3,), in input units."}});

  bind_kind<Cylinder>(module, "Cylinder",
                      "The circular cylinder of a radius about an axis. Points are mirrored along "
                      "the radius; those\n"
                      "on the axis and those farther than 2r from it have no image.",
                      {{"point", "A point of the axis (3,)."},
                       {"axis", "Unit direction (3,)."},
                       {"radius", "In input units."}})
      .def(py::init([](const VectorArgument& point, const VectorArgument& axis, double radius) {
             return std::make_shared<Cylinder>(point.vector, axis.vector, radius);
           }),
           py::arg("point"), py::arg("axis"), py::arg("radius"));

  bind_kind<Quadric>(module, "Quadric", "The quadric x' A x + b . x + c = 0.",
                     {{"matrix", "A (3, 3)."}, {"linear", "b (3,)."}, {"constant", "c."}})
      .def(py::init([](const Matrix3& matrix, const VectorArgument& linear, double constant) {
             return std::make_shared<Quadric>(matrix, linear.vector, constant);
           }),
           py::arg("matrix"), py::arg("linear"), py::arg("constant"));

  module.def(
      "bend",
      [](const PointsArgument& points, const Mirror& mirror, bool back) {
        return owned_array(interruptible([&](const Context& context) {
          return bend(PointsView(points), mirror, back ? Bend::Restore : Bend::Straighten, context);
        }));
      },
      py::arg("points"), py::arg("mirror"), py::arg("back") = false,
      "Points (n, 3) carried along while a curved mirror flattens into its plane, or, with\n"
      "``back``, while the plane bends into the mirror.\n\n"
      "Each point keeps its distance from the mirror and the coordinates of its foot. A cylinder\n"
      "unrolls; other mirrors are laid out from the middle of their footprint, true to length\n"
      "along the two lines through it. A shape that the mirror reflects onto itself comes out\n"
      "symmetric about ``straight_mirror(mirror)``. A mirror made by hand is laid out over the\n"
      "points' own feet. Rows without a foot are NaN. Raises InvalidInput when no point has one.");
  module.def(
      "fit_mirror",
      [](const PointsArgument& points, const std::string& kind,
         const std::optional<VectorArgument>& direction) {
        return interruptible([&](const Context& context) {
          return fit_mirror(PointsView(points), kind,
                            direction ? std::optional(direction->vector) : std::nullopt, context);
        });
      },
      py::arg("points"), py::arg("kind") = "auto", py::arg("direction") = py::none(),
      "The mirror that points (n, 3) lie on.");
  module.def(
      "straight_mirror",
      [](const Mirror& mirror, const std::optional<PointsArgument>& points) {
        return std::make_shared<Plane>(without_gil(
            [&] { return straight_mirror(mirror, points ? PointsView(*points) : PointsView()); }));
      },
      py::arg("mirror"), py::arg("points") = py::none(),
      "The Plane that ``bend`` flattens the mirror into.\n\n"
      "points: (n, 3), for a mirror made by hand.");
}

}  // namespace symsurf::python
