#include <symsurf/mirrors.h>

#include <memory>
#include <string>

#include "arrays.h"
#include "bindings.h"
#include "context.h"

namespace symsurf::python {

namespace {

// A view of a field, which keeps the points alive.
template <typename Field>
auto field(Field ReflectionPoints::*member) {
  return [member](const std::shared_ptr<ReflectionPoints>& points) {
    return shared_array((*points).*member, points);
  };
}

std::shared_ptr<ReflectionPoints> reflected(const Mirror& mirror, const py::object& source,
                                            const VectorArgument& eye, const py::object& threads,
                                            const py::object& progress) {
  // One source is a row.
  const py::object rows = has_points(source)
                              ? points_of(source)
                              : py::module_::import("numpy").attr("atleast_2d")(source);
  const auto sources = rows_from(rows, "sources");
  const Context context = context_from(progress, threads);
  return without_gil([&] {
    return std::make_shared<ReflectionPoints>(
        reflection_points(mirror, sources, eye.vector, context));
  });
}

}  // namespace

void bind_optics(py::module_& module) {
  using Class = py::class_<ReflectionPoints, std::shared_ptr<ReflectionPoints>>;
  Class(module, "ReflectionPoints",
        "Where a mirror reflects light of sources to an eye; m points, ordered by source, then by\n"
        "path length. len() is m.")
      .def_property_readonly("positions", field(&ReflectionPoints::positions),
                             "(m, 3), on the mirror, in input units.")
      .def_property_readonly("sources", field(&ReflectionPoints::sources),
                             "(m,) of each point the row of its source.")
      .def_property_readonly("path_lengths", field(&ReflectionPoints::path_lengths),
                             "(m,) |s - x| + |x - e|, in input units.")
      .def_property_readonly("irradiance", field(&ReflectionPoints::irradiance),
                             "(m,) at the eye, across the ray, of a source of unit intensity; per "
                             "input unit squared.\n"
                             "inf where the eye is in the focus.")
      .def("__len__", [](const ReflectionPoints& points) { return points.positions.rows(); })
      .def("__repr__", [](const ReflectionPoints& points) {
        return "ReflectionPoints(" + std::to_string(points.positions.rows()) + " points)";
      });

  auto mirror = module.attr("Mirror").cast<py::class_<Mirror, std::shared_ptr<Mirror>>>();
  mirror.def(
      "reflection_points", &reflected, py::arg("source"), py::arg("eye"), py::kw_only(),
      py::arg("threads") = 0, py::arg("progress") = py::none(),
      "All points of the mirror at which light is reflected from a source s to the eye e, not to\n"
      "be mixed up with images: by Fermat's principle those x at which the path |s - x| + |x - e|\n"
      "is stationary, to 1e-10 of it, with s and e on the same side of the tangent plane\n"
      "(Mitchell and Hanrahan 1992). Both sides reflect; what stands in the way is not looked "
      "at.\n\n"
      "source: (3,), or (n, 3) for many; eye: (3,), in the unit of the mirror.\n"
      "threads: 0 for all; progress: called with 0 to 1, cancels where it returns False.\n"
      "Planes, spheres and cylinders are solved in closed form, quadrics by a search in one\n"
      "dimension (after Miguel et al.), other mirrors by Newton's steps from a grid over their\n"
      "footprint. Where a whole curve reflects, points in one plane through both ends stand for "
      "it.\n"
      "A source or an eye on the mirror is not reflected where it lies. The irradiance is\n"
      "cos^2 t / (d1^2 d2^2 |det H|): d1 and d2 the parts of the path, t the angle of incidence, "
      "H\n"
      "the Hessian of the path length on the mirror; on a plane 1 / (d1 + d2)^2.\n"
      "Raises InvalidInput for other shapes, numbers that are not finite, and a SurfaceMirror "
      "made\n"
      "by hand; InvalidParameter; Cancelled.");
}

}  // namespace symsurf::python
