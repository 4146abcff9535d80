#pragma once

#include "../plane/symmetry_measure.h"

namespace symsurf {

/// Hruda's symmetry measure with spheres for planes: s(c, r) = sum_ij phi(|r(x_i) - x_j|) over all
/// pairs. Images that do not exist contribute nothing.
class SphereMeasure {
 public:
  explicit SphereMeasure(const Points& points) : pairs_(points) {}

  /// s at (centre, radius), and its gradient where asked for.
  double operator()(const Eigen::Vector4d& s, Eigen::Vector4d* gradient = nullptr) const {
    const Vector3 centre = s.head<3>();
    const double radius = s[3];
    if (gradient) gradient->setZero();
    double sum = 0;
    for (Index i = 0; i < pairs_.size(); ++i) {
      const Vector3 arm = pairs_.point(i) - centre;
      const double length = arm.norm();
      if (!(length > 1e-9) || length > 2 * radius) continue;
      const Vector3 u = arm / length;
      Vector3 pull;
      sum += pairs_.similarity(centre + (2 * radius - length) * u, pull);
      if (!gradient) continue;
      // dx'/dc = 2I - 2r/|x - c| (I - u u'), dx'/dr = 2u.
      const double bend = 2 * radius / length, along = u.dot(pull);
      gradient->head<3>() += (2 - bend) * pull + bend * along * u;
      (*gradient)[3] += 2 * along;
    }
    return sum;
  }

 private:
  SymmetryMeasure pairs_;
};

}  // namespace symsurf
