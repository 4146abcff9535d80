#include "sphere_candidates.h"

#include <algorithm>
#include <array>

#include "../parametric/pair_hypotheses.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 40000, pairs_kept = 4000;

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

// Of each size of spheres, the largest first. Diagonals.
constexpr std::array least_radii{0.7, 0.3, 0.0};

}  // namespace

std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  const auto through = [](const Vector3& middle, const Vector3& u, const auto& add) {
    for (const double curvature : curvatures)
      for (const double side : {-1.0, 1.0})
        add(UnitSphere{middle + side / curvature * u, 1 / curvature});
  };
  std::vector<UnitSphere> left =
      hypotheses_of_pairs<UnitSphere>(surfels, seed, pairs_tried, pairs_kept, through);
  // Each size apart: of a ball any plane through its middle explains more than most spheres do.
  std::vector<SphereCandidate> candidates;
  for (const double least : least_radii) {
    const auto rest = std::stable_partition(left.begin(), left.end(),
                                            [&](const UnitSphere& s) { return s.radius < least; });
    const std::vector<UnitSphere> chosen(rest, left.end());
    left.erase(rest, left.end());
    for (const SphereCandidate& candidate :
         best_of(chosen, surfels, map, count / static_cast<Index>(least_radii.size()), context))
      candidates.push_back(candidate);
  }
  return candidates;
}

}  // namespace symsurf
