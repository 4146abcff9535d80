#include "fit/shapes.h"

#include <Eigen/LU>

#include "base/linear_algebra.h"
#include "base/math.h"

namespace symsurf {

namespace {

using Change = GeneralQuadric::Change;
using Slopes = Eigen::Matrix<double, 3, 10>;

Change monomials(const Vector3& p) {
  Change m;
  m << p.cwiseAbs2(), p.x() * p.y(), p.y() * p.z(), p.z() * p.x(), p, 1;
  return m;
}

Slopes slopes_of_monomials(const Vector3& p) {
  Slopes s = Slopes::Zero();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    s(a, a) = 2 * p[a];
    s(a, 3 + a) = p[b];
    s(b, 3 + a) = p[a];
    s(a, 6 + a) = 1;
  }
  return s;
}

Quadric quadric_from(const Change& q) {
  Matrix3 matrix;
  matrix << q[0], q[3] / 2, q[5] / 2, q[3] / 2, q[1], q[4] / 2, q[5] / 2, q[4] / 2, q[2];
  return Quadric(matrix, q.segment<3>(6), q[9]);
}

}  // namespace

GeneralQuadric::GeneralQuadric(const Change& q)
    : coefficients(q / q.norm()), quadric(quadric_from(coefficients)) {}

std::optional<GeneralQuadric> GeneralQuadric::nearest_to(
    const std::vector<std::pair<Vector3, Vector3>>& points) {
  if (points.size() < 10) return std::nullopt;
  Eigen::Matrix<double, 10, 10> matrix = Eigen::Matrix<double, 10, 10>::Zero();
  Change right = Change::Zero();
  constexpr double slope_weight = 0.01;
  for (const auto& [x, normal] : points) {
    const Change m = monomials(x);
    const Slopes s = slopes_of_monomials(x);
    matrix += m * m.transpose() + slope_weight * s.transpose() * s;
    right += slope_weight * s.transpose() * normal;
  }
  matrix.diagonal().array() += double_rounding * matrix.trace();
  const Change q = solved(matrix, right);
  if (!q.allFinite() || !(q.head<9>().norm() > 0)) return std::nullopt;
  return GeneralQuadric(q);
}

Slopes GeneralQuadric::slopes(const Vector3& x) const {
  const Vector3 y = quadric.foot(x), g = quadric.gradient(y);
  const double l = g.dot(x - y) / g.squaredNorm();
  Matrix4 matrix = Matrix4::Zero();
  matrix.topLeftCorner<3, 3>() = Matrix3::Identity() + 2 * l * quadric.matrix();
  matrix.topRightCorner<3, 1>() = g;
  matrix.bottomLeftCorner<1, 3>() = g.transpose();
  Eigen::Matrix<double, 4, 10> right;
  right << -l * slopes_of_monomials(y), -monomials(y).transpose();
  return 2 * matrix.partialPivLu().solve(right).topRows<3>();
}

}  // namespace symsurf
