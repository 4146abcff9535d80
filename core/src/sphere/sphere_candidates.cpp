#include "sphere_candidates.h"

#include <array>

#include "../parametric/pair_hypotheses.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 40000, pairs_kept = 4000;

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

}  // namespace

std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  const auto through = [](const Vector3& middle, const Vector3& u, const auto& add) {
    for (const double curvature : curvatures)
      for (const double side : {-1.0, 1.0})
        add(UnitSphere{middle + side / curvature * u, 1 / curvature});
  };
  return best_of(hypotheses_of_pairs<UnitSphere>(surfels, seed, pairs_tried, pairs_kept, through),
                 surfels, map, count, context);
}

}  // namespace symsurf
