#include <symsurf/mirrors.h>

#include "search/registry.h"
#include "search/search.h"
#include "search/search_result.h"

namespace symsurf::perpendicular {

namespace {

Result run_perpendicular(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  Search search =
      perpendicular::search(cloud, values.integer("sample_size"), context.stage(0, 0.7));
  Result result;
  result.method = "perpendicular";
  result.statistics["noise"] = search.cloud.noise * search.cloud.diagonal;
  std::vector<Found> found;
  for (GrownSurface& surface : search.surfaces) {
    std::shared_ptr<Mirror> mirror = in_input_units(*surface.mirror, search.cloud);
    found.push_back({std::move(mirror), std::move(surface)});
  }
  fill(result, cloud, search.cloud, found, values, context.stage(0.7, 1));
  return result;
}

}  // namespace

}  // namespace symsurf::perpendicular

namespace symsurf {

MethodImplementation perpendicular_method() {
  MethodImplementation method;
  method.name = "perpendicular";
  method.title = "Curved mirror, perpendicular mapping";
  method.summary =
      "Finds a curved mirror of any shape that maps points along its normals, by growing surfaces "
      "of oriented midpoints and by bending planes.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.automatic = true;
  method.run = perpendicular::run_perpendicular;
  return method;
}

}  // namespace symsurf
