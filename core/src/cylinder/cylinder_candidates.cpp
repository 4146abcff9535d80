#include "cylinder_candidates.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "../random.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 30000, pairs_kept = 2000;
constexpr double shortest_chord = 0.05;
constexpr double facing_cosine = 0.88;  // 28 degrees
constexpr int axes = 6;                 // directions over the half circle

// To both sides of the pair. In units of the inverse diagonal.
constexpr std::array curvatures{0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6};

std::vector<UnitCylinder> cylinders_of_pairs(const Surfels& surfels, std::uint64_t seed) {
  Random random(seed);
  std::vector<UnitCylinder> cylinders;
  Index kept = 0;
  for (Index trial = 0; trial < pairs_tried && kept < pairs_kept; ++trial) {
    const Surfel& a = surfels[random.below(surfels.size())];
    const Surfel& b = surfels[random.below(surfels.size())];
    const Vector3 chord = b.position - a.position;
    const double length = chord.norm();
    if (length < shortest_chord) continue;
    const Vector3 u = chord / length, middle = (a.position + b.position) / 2;
    const Vector3 first = u.unitOrthogonal(), second = u.cross(first);
    bool faced = false;
    for (int k = 0; k < axes; ++k) {
      const double angle = std::numbers::pi * k / axes;
      const Vector3 axis = std::cos(angle) * first + std::sin(angle) * second;
      for (const double curvature : curvatures)
        for (const double side : {-1.0, 1.0}) {
          const UnitCylinder cylinder{middle + side / curvature * u, axis, 1 / curvature};
          if (length > 1.9 * cylinder.radius) continue;
          const double cosine = cylinder.reflect_direction(a.position, a.normal).dot(b.normal);
          if (std::abs(cosine) < facing_cosine && a.flatness * b.flatness > 0.25) continue;
          cylinders.push_back(cylinder);
          faced = true;
        }
    }
    kept += faced;
  }
  return cylinders;
}

}  // namespace

std::vector<CylinderCandidate> candidate_cylinders(const Surfels& surfels, const SurfelMap& map,
                                                   std::uint64_t seed, Index count) {
  return best_of(cylinders_of_pairs(surfels, seed), surfels, map, count);
}

}  // namespace symsurf
