#pragma once

#include <vector>

#include "cloud/surface_points.h"

namespace symsurf {

/// The surfaces of a cloud between its points: about each point a quadratic patch over its tangent
/// plane, fitted to its neighbours.
class SurfacePatches {
 public:
  SurfacePatches(const SurfacePoints& cloud, Index neighbours, const Context& context);

  /// How far x must move along the unit direction to lie on the patch about point j; NaN where the
  /// patch and the direction are nearly parallel.
  double along(Index j, const Vector3& x, const Vector3& direction) const;

  const Vector3& normal(Index j) const { return patches_[j].normal; }

 private:
  struct Patch {
    Vector3 centre, first, second, normal;  // orthonormal frame
    Eigen::Matrix<double, 6, 1> height;     // 1, a, b, a², ab, b²
    double reach;                           // beyond it the patch goes on flat
  };
  std::vector<Patch> patches_;
};

}  // namespace symsurf
