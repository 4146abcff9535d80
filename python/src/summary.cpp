#include <symsurf/mirror.h>
#include <symsurf/point_summary.h>

#include <span>
#include <string_view>

#include "arrays.h"
#include "bindings.h"
#include "context.h"

namespace symsurf::python {

namespace {

py::bytes state_of(const PointSummary& summary) {
  const auto bytes = without_gil([&] { return summary.bytes(); });
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PointSummary from_state(const py::bytes& state) {
  const auto bytes = std::as_bytes(std::span(std::string_view(state)));
  return without_gil([&] { return PointSummary::from_bytes(bytes); });
}

}  // namespace

void bind_summary(py::module_& module) {
  py::class_<PointSummary>(module, "PointSummary", R"(Any number of points in bounded memory.

A grid of cubic cells, and of each the number of its points and their mean. The grid is the finest of
edge 2^k that has at most ``cells`` occupied ones, so far points cost a cell each and no resolution.
Sums are integers, so summaries of parts add up to that of the whole in any order and number of parts,
to the bit. It pickles; equal summaries have equal pickles. One thread at a time may use it.

Args:
    cells: maximum number of occupied cells, in [64, 2^28]; 120 bytes each.

Raises InvalidParameter for another number.)")
      .def(py::init<Index>(), py::arg("cells") = PointSummary::usual_cells)
      .def(
          "add",
          [](PointSummary& summary, const PointSummary& other) {
            without_gil([&] { summary.add(other); });
          },
          py::arg("other"), "Adds all of another. Raises InvalidParameter where its limit differs.")
      .def(
          "add",
          [](PointSummary& summary, const PointsArgument& points) {
            without_gil([&] { summary.add(points); });
          },
          py::arg("points"),
          "Adds points (n, 3), n >= 0; those that are not finite are counted apart. Raises\n"
          "InvalidInput for another shape or a coordinate beyond 1e50, and adds nothing then.")
      .def_property_readonly("cells", &PointSummary::cells, "The limit of occupied cells.")
      .def_property_readonly("count", &PointSummary::count, "Finite points that were added.")
      .def_property_readonly("nonfinite", &PointSummary::nonfinite, "The others.")
      .def_property_readonly("edge", &PointSummary::edge, "Of a cell, in input units.")
      .def_property_readonly(
          "means", [](const PointSummary& summary) { return owned_array(summary.means()); },
          "(m, 3): the mean of the points of each occupied cell, in the cells' order.")
      .def_property_readonly(
          "counts", [](const PointSummary& summary) { return owned_array(summary.counts()); },
          "(m,): how many points each cell has, in the same order.")
      .def("__len__", &PointSummary::size, "Occupied cells.")
      .def(py::pickle(&state_of, &from_state));
  py::class_<SurfaceMatcher>(module, "SurfaceMatcher",
                             "For symsurf.match_chunks: where images fall on a thinned shape.")
      .def(py::init([](const PointsArgument& surface, const Mirror& mirror) {
             return without_gil(
                 [&] { return SurfaceMatcher(PointsView(surface).matrix(), mirror); });
           }),
           py::arg("surface"), py::arg("mirror"), py::keep_alive<1, 3>())
      .def(
          "match",
          [](const SurfaceMatcher& matcher, const PointsArgument& points, double distance,
             const py::object& threads) {
            const Context context = context_from(py::none(), threads);
            auto matches = without_gil([&] { return matcher.match(points, distance, context); });
            return py::make_tuple(owned_array(std::move(matches.partners)),
                                  owned_array(std::move(matches.residuals)));
          },
          py::arg("points"), py::arg("distance"), py::arg("threads") = 0,
          "Partners and residuals.");
}

}  // namespace symsurf::python
