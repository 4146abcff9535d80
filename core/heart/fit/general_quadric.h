#pragma once

#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace symsurf {

/// A quadric while it is searched for: q . (x^2, y^2, z^2, xy, yz, zx, x, y, z, 1) = 0, |q| = 1.
struct GeneralQuadric {
  using Change = Eigen::Vector<double, 10>;

  explicit GeneralQuadric(const Change& q);

  /// f = 0 and grad f = n at points with normals, by least squares: linear in the coefficients.
  /// None of fewer than ten.
  static std::optional<GeneralQuadric> nearest_to(
      const std::vector<std::pair<Vector3, Vector3>>& points);

  Vector3 reflect(const Vector3& x) const { return 2 * quadric.foot(x) - x; }

  /// By how much each coefficient moves the image of x, from the conditions of the closest point,
  /// y - x + l g(y) = 0 and f(y) = 0.
  Eigen::Matrix<double, 3, 10> slopes(const Vector3& x) const;

  std::pair<GeneralQuadric, double> stepped(const Change& by) const {
    if (!by.allFinite()) return {*this, 0};
    return {GeneralQuadric(coefficients + by), by.norm()};
  }
  static constexpr double ridge = 1e-9;  // the length of the coefficients moves nothing

  Change coefficients;
  Quadric quadric;
};

}  // namespace symsurf
