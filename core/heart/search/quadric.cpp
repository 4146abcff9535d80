#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/math.h"
#include "fit/fitted.h"
#include "fit/shapes.h"
#include "search/methods.h"
#include "search/perpendicular.h"

namespace symsurf::perpendicular {

namespace {

constexpr int rounds = 12, steps_a_round = 3;
constexpr std::size_t least_matches = 20;  // of points: two a coefficient

double scale_of(const SearchCloud& cloud, const GrownSurface& surface) {
  std::vector<double> misses;
  for (const Carried& c : surface.carried)
    misses.push_back(surface.exact ? c.miss.norm() : std::abs(c.miss.dot(c.partner_normal)));
  return std::max(1.5 * median(std::move(misses)), 0.02 * cloud.spacing);
}

// Misses across the partner's surface count, along it only where partners are exact.
GeneralQuadric stepped(const SearchCloud& cloud, const GrownSurface& surface,
                       const GeneralQuadric& model, double scale) {
  cloud.context.check();
  const double along = surface.exact ? 1 : 0.0064;
  GaussNewton<GeneralQuadric> sum;
  for (std::size_t k = 0; k < surface.points.size(); ++k) {
    const Vector3 x = cloud.point(surface.points[k]), n = surface.carried[k].partner_normal;
    const Vector3 miss = model.reflect(x) - cloud.point(surface.partners[k]);
    const Metric metric{along, 1 - along, n};
    const double weight = biweight(std::sqrt(miss.dot(Matrix3(metric) * miss)) / (4.7 * scale));
    if (weight > 0) sum.add(model, x, miss, metric, weight);
  }
  return sum.taken(model).first;
}

// The quadric nearest to a surface, matched to the cloud and fitted to its pairs again and again
// (Tukey's weights). The surface gets its pairs and support; none when the surface has too few
// points or nothing fits.
std::optional<Quadric> fitted_quadric(const SearchCloud& cloud, GrownSurface& surface) {
  std::vector<std::pair<Vector3, Vector3>> feet;
  for (const Carried& c : surface.carried) feet.emplace_back(c.foot, c.normal);
  std::optional<GeneralQuadric> model = GeneralQuadric::nearest_to(feet);
  if (!model) return std::nullopt;
  surface.mirror = nullptr;
  for (int round = 0; round <= rounds; ++round) {
    const Quadric& quadric = model->quadric;
    match(
        cloud,
        [&](const Vector3& x, Vector3& foot, Vector3& normal) {
          const std::optional<Foot> at = quadric.at(x);
          if (!at) return false;
          foot = at->point;
          normal = at->normal;
          return true;
        },
        surface);
    if (surface.points.size() < least_matches) return std::nullopt;
    const double scale = scale_of(cloud, surface);
    for (int k = 0; k < steps_a_round && round < rounds; ++k)
      model = stepped(cloud, surface, *model, scale);
  }
  surface.support = support(cloud, surface);
  return model->quadric;
}

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
