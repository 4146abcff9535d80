#include <symsurf/points.h>

#include <string>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "values.h"

namespace symsurf::python {

namespace {

py::array_t<double> downsampled(const PointsArgument& points, Index count) {
  return owned_array(without_gil([&] { return downsample(points, count); }));
}

py::array_t<double> normals_of(const PointsArgument& points, Index neighbours,
                               const std::string& method, const py::object& threads,
                               const py::object& progress) {
  const Context context = context_from(progress, threads);
  return owned_array(
      without_gil([&] { return estimate_normals(points, neighbours, method, context); }));
}

}  // namespace

void bind_sampling(py::module_& module) {
  module.def("downsample", &downsampled, py::arg("points"), py::arg("count"),
             "Points on a uniform grid, for symsurf.downsample.");
  module.def("estimate_normals", &normals_of, py::arg("points"), py::arg("neighbours"),
             py::arg("method"), py::arg("threads"), py::arg("progress"),
             "Unit normals, for symsurf.estimate_normals.");
}

}  // namespace symsurf::python
