#include <symsurf/synthetic.h>

#include <string>

#include "arrays.h"
#include "bindings.h"
#include "context.h"

namespace symsurf::python {

namespace {

py::dict to_dict(const SurfaceErrors& errors) {
  py::dict figures;
  figures["rmse"] = errors.rmse;
  figures["e_max"] = errors.e_max;
  figures["e_avg"] = errors.e_avg;
  figures["bias"] = errors.bias;
  figures["counted"] = errors.counted;
  figures["skipped"] = errors.skipped;
  return figures;
}

}  // namespace

void bind_metrics(py::module_& module) {
  module.def("surface_errors", [](const PointsArgument& surface_points, const std::string& name) {
    return to_dict(without_gil([&] { return surface_errors(surface_points, surface(name)); }));
  });
  module.def("surface_errors",
             [](const PointsArgument& surface_points, const SurfaceMirror& surface) {
               return to_dict(without_gil([&] { return surface_errors(surface_points, surface); }));
             });
  module.def("sphere_errors", [](const Sphere& found, const Sphere& truth,
                                 const PointsArgument& points) {
    const SphereErrors errors = without_gil([&] { return sphere_errors(found, truth, points); });
    return py::make_tuple(errors.e_c, errors.e_r);
  });
  module.def("surface_distance", [](const PointsArgument& surface_points, const Mirror& truth,
                                    const PointsArgument& points) {
    return without_gil([&] { return surface_distance(surface_points, truth, points); });
  });
  module.def("coverage", [](const PointsArgument& surface_points, const Mirror& truth,
                            const PointsArgument& points, double tolerance) {
    return without_gil([&] { return coverage(surface_points, truth, points, tolerance); });
  });
}

}  // namespace symsurf::python
