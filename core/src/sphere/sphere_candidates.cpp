#include "sphere_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../plane/agreement.h"
#include "../random.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 40000, pairs_kept = 4000;
constexpr double shortest_chord = 0.05;
constexpr double facing_cosine = 0.88;  // 28 degrees

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

std::vector<UnitSphere> spheres_of_pairs(const Surfels& surfels, std::uint64_t seed) {
  Random random(seed);
  std::vector<UnitSphere> spheres;
  Index kept = 0;
  for (Index trial = 0; trial < pairs_tried && kept < pairs_kept; ++trial) {
    const Surfel& a = surfels[random.below(surfels.size())];
    const Surfel& b = surfels[random.below(surfels.size())];
    const Vector3 chord = b.position - a.position;
    const double length = chord.norm();
    if (length < shortest_chord) continue;
    const Vector3 u = chord / length, middle = (a.position + b.position) / 2;
    bool faced = false;
    for (const double curvature : curvatures)
      for (const double side : {-1.0, 1.0}) {
        const UnitSphere sphere{middle + side / curvature * u, 1 / curvature};
        if (length > 1.9 * sphere.radius) continue;
        const double cosine = sphere.reflect_direction(a.position, a.normal).dot(b.normal);
        if (std::abs(cosine) < facing_cosine && a.flatness * b.flatness > 0.25) continue;
        spheres.push_back(sphere);
        faced = true;
      }
    kept += faced;
  }
  return spheres;
}

}  // namespace

std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count) {
  return best_of(spheres_of_pairs(surfels, seed), surfels, map, count);
}

}  // namespace symsurf
