#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "search/parametric.h"
#include "search/plane.h"

namespace symsurf {

namespace {

constexpr double steepest = 1.3;  // radians between direction and normal: more is no shear

using Candidates = std::vector<Candidate<UnitObliquePlane>>;

// Divided by the standard deviations along the principal axes, an oblique plane of symmetry is an
// ordinary one.
void add_whitened_planes(const Points& points, Index sample_size, Candidates& found,
                         const Context& context) {
  const PrincipalFrame frame = principal_frame(points, context);
  // Diagonals, by which a flat cloud is not divided.
  const Vector3 deviations =
      (frame.variance.cwiseMax(0).cwiseSqrt() / frame.size).cwiseMax(single_rounding);
  const Points whitened = frame.to_frame(points, context) * deviations.cwiseInverse().asDiagonal();
  const Cloud white = checked_cloud(whitened, {}, 1, context);
  const Surfels& surfels = white.patches(sample_size / 2, context);
  for (const PlaneCandidate& candidate : promising_planes(surfels, SurfelMap(surfels), context)) {
    const Plane plane = in_input_units(candidate.shape, white.frame);
    const Vector3 normal = frame.axes * plane.normal().cwiseQuotient(deviations);
    const double length = normal.norm();
    found.push_back(
        {{normal / length, (frame.size * plane.offset() - normal.dot(frame.centroid)) / length,
          length * frame.axes * plane.normal().cwiseProduct(deviations)}});
  }
}

// The rows but for a share of them, those nearest to one.
Points without_neighbours(const Points& points, Index row, double share) {
  const Vector3 centre = points.row(row).transpose();
  std::vector<std::pair<double, Index>> rows;
  for (Index i = 0; i < points.rows(); ++i)
    rows.emplace_back((points.row(i).transpose() - centre).squaredNorm(), i);
  const auto first = rows.begin() + static_cast<Index>(share * static_cast<double>(rows.size()));
  std::nth_element(rows.begin(), first, rows.end());
  std::vector<Index> left;
  for (auto one = first; one != rows.end(); ++one) left.push_back(one->second);
  return chosen_rows(points, left);
}

// A body that has lost a part is white without what was opposite, so that candidates come from the
// body without each of several parts of it, too.
Candidates whitened_planes(const Surfels& surfels, Index sample_size, const Context& context) {
  constexpr Index parts = 8;
  constexpr double share = 0.2;
  const Points points = surfels.positions(2000);
  Candidates found;
  add_whitened_planes(points, sample_size, found, context);
  for (Index k = 0; k < parts; ++k) {
    context.check();
    add_whitened_planes(without_neighbours(points, k * points.rows() / parts, share), sample_size,
                        found, context);
  }
  return found;
}

Result run_oblique_plane(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  constexpr Fit rough{.samples = 250, .tolerance = 0.04, .steps = 8};
  const Index sample_size = values.integer("sample_size");
  const Surfels& coarse = cloud.patches(sample_size, context.stage(0, 0.1));
  const Surfels& fine = cloud.finer_patches(sample_size, context.stage(0.1, 0.2));
  Candidates found = whitened_planes(fine, sample_size, context.stage(0.2, 0.2));
  const NearestPoints points(cloud, context.stage(0.3, 0.4));
  const Refinement refinement(cloud, points, coarse, fine);
  const MirrorScore score(cloud, context.stage(0.45, 0.5));
  fit_to_all(found, refinement, score, cloud.frame, rough, context.stage(0.5, 0.7));
  suppress_non_maxima(found, alike_planes, refined_at_most);
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const auto& candidate : found) {
    context.check();
    const UnitObliquePlane close = refinement.refined(candidate.shape);
    if (close.direction.norm() < 1 / std::cos(steepest))
      mirrors.push_back(mirror_of(close, cloud.frame));
  }
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
