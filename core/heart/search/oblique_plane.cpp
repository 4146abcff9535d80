#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "search/parametric.h"

namespace symsurf {

namespace {

constexpr double steepest = 1.3;  // radians between direction and normal: more is no shear

// Divided by the standard deviations along the principal axes, an oblique plane of symmetry is an
// ordinary one.
Result whitened_planes(const Cloud& cloud, const Vector3& deviations, const Context& context) {
  const Points points = cloud.frame.to_frame(cloud.points, context.stage(0, 0.1)) *
                        deviations.cwiseInverse().asDiagonal();
  const MethodImplementation& plane = heart_method("plane");
  const Cloud white = checked_cloud(points, {}, plane.minimum_points, context.stage(0.1, 0.2));
  const ParameterValues values{
      plane.name, plane.parameters, {{"pairs", false}, {"max_candidates", Index{3}}}};
  return plane.run(white, values, context.stage(0.2, 1));
}

UnitObliquePlane sheared(const Mirror& found, const Vector3& deviations) {
  const Foot foot = *found.at(Vector3::Zero());
  const Vector3 normal = foot.normal.cwiseQuotient(deviations);
  const double length = normal.norm();
  return {normal / length, foot.distance / length, length * foot.normal.cwiseProduct(deviations)};
}

Result run_oblique_plane(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  // Diagonals, by which a flat cloud is not divided.
  const Vector3 deviations =
      (cloud.frame.variance.cwiseMax(0).cwiseSqrt() / cloud.frame.size).cwiseMax(single_rounding);
  const Result white = whitened_planes(cloud, deviations, context.stage(0, 0.5));
  const Index sample_size = values.integer("sample_size");
  const NearestPoints points(cloud, context.stage(0.5, 0.6));
  const Refinement refinement(cloud, points, cloud.patches(sample_size, context.stage(0.6, 0.62)),
                              cloud.finer_patches(sample_size, context.stage(0.62, 0.65)));
  const MirrorScore score(cloud, context.stage(0.65, 0.7));
  std::vector<std::shared_ptr<Mirror>> mirrors;
  const auto add = [&](const Result& start) {
    context.check();
    // A body that has lost a part is not quite white.
    const UnitObliquePlane rough = refinement.fitted(
        sheared(*start.mirror, deviations), {.samples = 1000, .tolerance = 0.03, .steps = 12});
    const UnitObliquePlane close = refinement.refined(rough);
    if (close.direction.norm() < 1 / std::cos(steepest))
      mirrors.push_back(mirror_of(close, cloud.frame));
  };
  add(white);
  std::for_each(white.candidates.begin(), white.candidates.end(), add);
  if (mirrors.empty()) return {};
  Result best = score.ranked("oblique_plane", mirrors);
  add_pairs(best, cloud, values, context.stage(0.8, 1));
  return best;
}

}  // namespace

MethodImplementation oblique_plane_method() {
  MethodImplementation method;
  method.name = "oblique_plane";
  method.title = "Oblique mirror plane";
  method.summary =
      "Finds the plane and the direction along which it mirrors the shape: the symmetry of a body "
      "that was sheared, such as a deformed fossil.";
  method.parameters = {
      surfels_searched(1000, "the plane"),
      pair_distance(),
  };
  method.minimum_points = 12;
  method.automatic = true;
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_oblique_plane;
  return method;
}

}  // namespace symsurf
