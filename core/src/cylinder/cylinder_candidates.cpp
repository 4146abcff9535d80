#include "cylinder_candidates.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "../parametric/pair_hypotheses.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 30000, pairs_kept = 2000;
constexpr int axes = 6;  // directions over the half circle

// To both sides of the pair. In units of the inverse diagonal.
constexpr std::array curvatures{0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6, 6.5, 9.0};

}  // namespace

std::vector<CylinderCandidate> candidate_cylinders(const Surfels& surfels, const SurfelMap& map,
                                                   std::uint64_t seed, Index count,
                                                   const Context& context) {
  const auto through = [](const Vector3& middle, const Vector3& u, double most, const auto& add) {
    const Vector3 first = u.unitOrthogonal(), second = u.cross(first);
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
      hypotheses_of_pairs<UnitCylinder>(surfels, seed, pairs_tried, pairs_kept, through),
      [](const UnitCylinder& cylinder) { return cylinder.radius; }, surfels, map, count, context);
}

}  // namespace symsurf
