#include "methods/cylinder/cylinder_candidates.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "base/symmetric_eigen.h"
#include "methods/parametric/pair_hypotheses.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 30000, pairs_kept = 4000;
constexpr int axes = 6;  // directions over the half circle, the first as the normals tell

// To both sides of the pair. In units of the inverse diagonal.
constexpr std::array curvatures{0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6, 6.5, 9.0};

// Of a tube, its own: the normals of its surfaces lie across it.
Vector3 axis_of_normals(const Surfels& surfels) {
  Matrix3 normals = Matrix3::Zero();
  for (Index i = 0; i < surfels.size(); ++i)
    normals += surfels[i].flatness * surfels[i].normal * surfels[i].normal.transpose();
  return least_eigen_of(normals).vector;
}

// As far as it lies across u.
Vector3 axis_across(const Vector3& u, const Vector3& axis) {
  const Vector3 across = axis - axis.dot(u) * u;
  return across.norm() > 1e-6 ? across.normalized() : u.unitOrthogonal();
}

}  // namespace

std::vector<CylinderCandidate> candidate_cylinders(const Surfels& surfels, const SurfelMap& map,
                                                   std::uint64_t seed, Index count,
                                                   const Context& context) {
  const Vector3 of_normals = axis_of_normals(surfels);
  const auto through = [&](const Vector3& middle, const Vector3& u, double most, const auto& add) {
    const Vector3 first = axis_across(u, of_normals), second = u.cross(first);
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
