#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fit/candidate.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/auto.h"
#include "search/methods.h"

namespace symsurf {

namespace {

using CylinderCandidate = Candidate<UnitCylinder>;

constexpr Index pairs_tried = 30000, pairs_kept = 4000;
constexpr int axes = 6;  // directions over the half circle, the first along the cloud

// To both sides of the pair. In units of the inverse diagonal.
constexpr std::array curvatures{0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6, 6.5, 9.0};

// As far as it lies across u.
Vector3 axis_across(const Vector3& u, const Vector3& axis) {
  const Vector3 across = axis - axis.dot(u) * u;
  return across.norm() > 1e-6 ? across.normalized() : u.unitOrthogonal();
}

// Cylinders that mirror a pair of surfels onto each other, normals included. A pair fixes a point
// and the normal of the cylinder there; curvature and direction of the axis are scanned. The best
// `count` that differ.
std::vector<CylinderCandidate> candidate_cylinders(const Surfels& surfels, const SurfelMap& map,
                                                   std::uint64_t seed, Index count,
                                                   const Context& context) {
  const auto through = [&](const Vector3& middle, const Vector3& u, double most, const auto& add) {
    const Vector3 first = axis_across(u, Vector3::UnitX()), second = u.cross(first);
    for (int k = 0; k < axes; ++k) {
      const double angle = std::numbers::pi * k / axes;
      const Vector3 axis = std::cos(angle) * first + std::sin(angle) * second;
      for (const double curvature : curvatures)
        for (const double side : {-1.0, 1.0})
          if (curvature <= most)
            add(UnitCylinder{middle + side / curvature * u, axis, 1 / curvature});
    }
  };
  return best_of_each_size(
      hypotheses_of_pairs<UnitCylinder>(surfels, seed, pairs_tried, pairs_kept, through, context),
      [](const UnitCylinder& cylinder) { return cylinder.radius; }, surfels, map, count, context);
}

constexpr Index started = 48;                  // candidates that are refined on the surfels
constexpr Index fitted_to_all = 8;             // of these, are fitted to the full cloud
constexpr std::size_t polished_cylinders = 3;  // and of these, to ever more of it
constexpr Fit of_each{.samples = 400, .steps = 4}, of_polished{.samples = 3000, .steps = 40};
constexpr double chance_explains = 0.35;  // what cylinders explain of random solids before that
constexpr double least_support = 0.6;     // of the best: without it 6 of 10 dented balls are lost
constexpr double alike_cylinders = 0.04;  // cylinders closer than this are one
constexpr double widest = 6;  // radius, in diagonals: wider ones hardly differ from planes

Cylinder in_input_units(const UnitCylinder& cylinder, const PrincipalFrame& frame) {
  return {frame.from_frame(cylinder.point), frame.axes * cylinder.axis,
          frame.size * cylinder.radius};
}

void drop_weakly_supported(std::vector<CylinderCandidate>& candidates) {
  std::erase_if(candidates, [](const CylinderCandidate& c) { return !(c.shape.radius < widest); });
  if (candidates.empty()) return;
  const double least = least_support * candidates.front().support;
  std::erase_if(candidates, [&](const CylinderCandidate& c) { return c.support < least; });
}

// On the thinned cloud alone.
std::vector<CylinderCandidate> refined_cylinders(const Surfels& surfels, std::uint64_t seed,
                                                 const Context& context) {
  const SurfelMap map(surfels);
  std::vector<CylinderCandidate> candidates =
      candidate_cylinders(surfels, map, seed, started, context);
  for (CylinderCandidate& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(surfels, map, candidate, 0.04, 0.02, 4, 3);
  }
  suppress_non_maxima(surfels, candidates, alike_cylinders, 2 * fitted_to_all);
  return candidates;
}

Result run_cylinder(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result best;
  best.method = "cylinder";
  const Index sample_size = values.integer("sample_size");
  const Surfels& surfels = cloud.patches(sample_size, context.stage(0, 0.1));
  std::vector<CylinderCandidate> candidates =
      refined_cylinders(surfels, cloud.seed, context.stage(0.1, 0.4));
  if (candidates.empty()) return best;

  const NearestPoints points(cloud, context.stage(0.4, 0.5));
  const Surfels& fine = cloud.patches(samples_a_patch * sample_size, context.stage(0.5, 0.6));
  const Refinement refinement(cloud, points, surfels, fine);
  for (CylinderCandidate& candidate : candidates) candidate = refinement.fitted(candidate, of_each);
  suppress_non_maxima(surfels, candidates, alike_cylinders, fitted_to_all);
  for (std::size_t i = 0; i < std::min(polished_cylinders, candidates.size()); ++i)
    if (i == 0 || candidates[i].support > chance_explains)
      candidates[i] = polished(candidates[i], of_polished, refinement);
  suppress_non_maxima(surfels, candidates, alike_cylinders, 1 + values.integer("max_candidates"));
  drop_weakly_supported(candidates);
  context.report(0.7);
  if (candidates.empty()) return best;

  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const CylinderCandidate& candidate : candidates)
    mirrors.push_back(std::make_shared<Cylinder>(in_input_units(candidate.shape, cloud.frame)));
  best = MirrorScore(cloud, context.stage(0.7, 0.75)).ranked("cylinder", mirrors);
  add_pairs(best, cloud, values, context.stage(0.75, 1));
  return best;
}

std::shared_ptr<Mirror> bent_cylinder(const PlaneBend& bend, const Refinement& refinement,
                                      const PrincipalFrame& frame) {
  const CylinderCandidate start{bend.cylinder()};
  return std::make_shared<Cylinder>(
      in_input_units(refinement.fitted(start, of_polished).shape, frame));
}

}  // namespace

MethodImplementation cylinder_method() {
  MethodImplementation method;
  method.name = "cylinder";
  method.title = "Mirror cylinder";
  method.summary =
      "Finds the circular cylinder that mirrors the shape along its radius: a plane of symmetry "
      "bent about an axis.";
  method.parameters = {
      surfels_searched(700, "the cylinder"),
      max_candidates(5, 7, "cylinders"),
      pair_distance(),
  };
  method.minimum_points = 12;
  method.automatic = true;
  method.distance_from = distance_from_cylinder;
  method.bent_from = bent_cylinder;
  method.run = run_cylinder;
  return method;
}

}  // namespace symsurf
