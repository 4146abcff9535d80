#include <symsurf/mirrors.h>

#include <algorithm>

#include "methods/free_form/search.h"
#include "methods/free_form/search_result.h"
#include "methods/quadric/quadric_fit.h"
#include "methods/registry.h"

namespace symsurf::perpendicular {

namespace {

// Finds free-form mirrors and fits quadrics to the best of them.
Result run_quadric(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  constexpr std::size_t most_fitted = 5;
  Search found = search(cloud, values.integer("sample_size"), context.stage(0, 0.6));
  std::vector<Found> fits;
  const std::size_t count = std::min(found.surfaces.size(), most_fitted);
  for (std::size_t k = 0; k < count; ++k) {
    context.stage(0.6, 0.7).report(static_cast<double>(k) / static_cast<double>(count));
    GrownSurface& surface = found.surfaces[k];
    if (const auto quadric = fitted_quadric(found.cloud, surface))
      fits.push_back({in_input_units(*quadric, found.cloud), surface});
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Found& a, const Found& b) {
    return a.surface.support > b.surface.support;
  });
  Result result;
  result.method = "quadric";
  fill(result, cloud, found.cloud, fits, values, context.stage(0.7, 1));
  return result;
}

}  // namespace

}  // namespace symsurf::perpendicular

namespace symsurf {

MethodImplementation quadric_method() {
  MethodImplementation method;
  method.name = "quadric";
  method.title = "Mirror quadric";
  method.summary =
      "Finds the quadric (ellipsoid, paraboloid, cone, saddle, ...) that mirrors the shape along "
      "its normals.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.run = perpendicular::run_quadric;
  return method;
}

}  // namespace symsurf
