#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "score/symmetry_measure.h"

namespace symsurf {

/// Hruda's symmetry measure with spheres for planes: s(p) = sum_ij phi(|r(p, x_i) - x_j|) over all
/// pairs, where r(p, x) reflects over the sphere a |x|^2 + b . x + c = 0, p = (a, b, c) of any
/// length with |b|^2 > 4 a c. Where a = 0 it is that of a plane. Images that do not exist
/// contribute nothing.
class SphereMeasure {
 public:
  using Coefficients = Eigen::Vector<double, 5>;

  explicit SphereMeasure(const Points& points) : pairs_(points) {}

  /// s(p), and its gradient where asked for.
  double operator()(const Coefficients& p, Coefficients* gradient = nullptr) const {
    const double a = p[0], c = p[4];
    const Vector3 b = p.segment<3>(1);
    if (gradient) gradient->setZero();
    const double squared = b.squaredNorm() - 4 * a * c;
    if (!(squared > 0)) return 0;
    const double unit = std::sqrt(squared);  // the slope on the sphere
    double sum = 0, by_unit = 0;
    for (Index i = 0; i < pairs_.size(); ++i) {
      const Vector3 x = pairs_.point(i), up = 2 * a * x + b;
      const double slope = up.norm();
      if (!(slope > 1e-9 * unit) || slope > 2 * unit) continue;
      // x' = x - m up, m = 4 F / ((unit + slope) slope).
      const double per_value = 4 / ((unit + slope) * slope);
      const double m = per_value * ((a * x + b).dot(x) + c);
      Vector3 pull;
      sum += pairs_.similarity(x - m * up, pull);
      if (!gradient) continue;
      const double along = up.dot(pull), by_value = -along * per_value;
      const double by_slope = along * m * (1 / (unit + slope) + 1 / slope);
      const Vector3 by_up = by_slope / slope * up - m * pull;
      (*gradient)[0] += by_value * x.squaredNorm() + 2 * by_up.dot(x);
      gradient->segment<3>(1) += by_value * x + by_up;
      (*gradient)[4] += by_value;
      by_unit += along * m / (unit + slope);
    }
    if (gradient) {
      (*gradient)[0] -= by_unit / unit * 2 * c;
      gradient->segment<3>(1) += by_unit / unit * b;
      (*gradient)[4] -= by_unit / unit * 2 * a;
    }
    return sum;
  }

 private:
  SymmetryMeasure pairs_;
};

}  // namespace symsurf
