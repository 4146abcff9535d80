#pragma once

#include <symsurf/points_view.h>

#include <vector>

namespace symsurf {

/// The symmetry measure of Hruda et al. (2022): s(p) = sum_ij phi(|r(p, x_i) - x_j|), where
/// r(p, x) reflects x over the plane p = (a, b, c, d), (a, b, c) of any length, and phi is the
/// Wendland function (1 - u)^5 (8 u^2 + 5 u + 1), u = alpha l / 2.6, zero from u = 1 on. All pairs
/// inside the support count; a uniform grid of that cell size finds them.
class SymmetryMeasure {
 public:
  /// alpha = 15 / l_avg, l_avg the mean distance of the points from their centroid.
  explicit SymmetryMeasure(const Points& points);

  /// s(p), and its gradient where asked for. Needs a non-zero (a, b, c).
  double operator()(const Eigen::Vector4d& p, Eigen::Vector4d* gradient = nullptr) const;

  double alpha() const { return alpha_; }

  /// The points, in an order of their own.
  Index size() const { return sorted_.rows(); }
  Vector3 point(Index i) const { return sorted_.row(i); }

  /// Sum over all points x_j of phi(|image - x_j|), and its gradient by the image.
  double similarity(const Vector3& image, Vector3& pull) const;

 private:
  double alpha_;
  double support_;
  Vector3 origin_;
  Eigen::Vector3i size_;
  std::vector<std::int32_t> start_;  // of each cell's run in sorted_
  Points sorted_;
};

/// phi of the measure at u in [0, 1], and phi'(u) / u.
double wendland(double u);
double wendland_slope(double u);

}  // namespace symsurf
