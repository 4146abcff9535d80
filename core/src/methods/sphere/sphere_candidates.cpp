#include "methods/sphere/sphere_candidates.h"

#include <algorithm>
#include <array>

#include "methods/parametric/pair_hypotheses.h"
#include "methods/sphere/large_spheres.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 40000, pairs_kept = 4000;

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

constexpr Index started = 48;          // candidates that are refined on the surfels
constexpr double least_support = 0.6;  // of the best; others are not fitted

// Spheres that mirror a pair of surfels onto each other, normals included. A pair fixes a point and
// the normal of the sphere there; the curvature is scanned. The best `count` that differ.
std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  const auto through = [](const Vector3& middle, const Vector3& u, double most, const auto& add) {
    add(UnitSphere{middle, u, 0});
    for (const double curvature : curvatures)
      if (curvature <= most)
        for (const double side : {-1.0, 1.0}) add(UnitSphere{middle, u, side * curvature});
  };
  return best_of_each_size(
      hypotheses_of_pairs<UnitSphere>(surfels, seed, pairs_tried, pairs_kept, through, context),
      [](const UnitSphere& sphere) { return sphere.radius(); }, surfels, map, count, context);
}

void drop_weakly_supported(std::vector<SphereCandidate>& candidates) {
  const double least = least_support * candidates.front().support;
  std::erase_if(candidates, [&](const SphereCandidate& c) { return c.support < least; });
}

}  // namespace

std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  std::vector<SphereCandidate> candidates = candidate_spheres(surfels, map, seed, started, context);
  if (candidates.empty()) candidates.push_back({});
  for (SphereCandidate& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(surfels, map, candidate, 0.04, 0.02, 4, 3);
  }
  std::vector<SphereCandidate> planes = take_planes(surfels, map, candidates);
  if (!candidates.empty()) {
    suppress_non_maxima(surfels, candidates, alike_spheres, started);
    drop_weakly_supported(candidates);
  }
  for (SphereCandidate& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(surfels, map, candidate, 0.02, 0.012, 4, 1);
  }
  suppress_non_maxima(surfels, candidates, alike_spheres, count);
  candidates.insert(candidates.end(), planes.begin(), planes.end());
  return candidates;
}

}  // namespace symsurf
