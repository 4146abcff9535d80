#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Core>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

Quadric::Quadric(const Matrix3& matrix, const Vector3& linear, double constant)
    : Quadric(matrix, Vector3::Zero(), linear, constant) {}

Quadric::Quadric(const Matrix3& matrix, const Vector3& origin, const Vector3& gradient,
                 double value)
    : origin_(origin),
      matrix_((matrix + matrix.transpose()) / 2),
      linear_(gradient),
      constant_(value) {
  // Not only those given, but also those about the coordinates' own origin, which numbers() names.
  if (!matrix_.allFinite() || !origin.allFinite() || !gradient.allFinite() ||
      !std::isfinite(value) || !linear().allFinite() || !std::isfinite(constant()) ||
      (matrix_.isZero(0) && gradient.isZero(0)))
    throw InvalidInput("a quadric needs finite numbers, and not all of A and b zero");
  const SymmetricEigen<3> eigen = eigen_of(matrix_);
  axes_ = eigen.vectors;
  curves_ = eigen.values;
}

Vector3 Quadric::foot(const Vector3& x) const {
  // In the eigenvectors' frame: y_i = (x_i - l b_i) / (1 + 2 l a_i). Between the poles f(y(l))
  // falls monotonically, so its zero there, if any, is one, and the closest point.
  const Vector3 p = axes_.transpose() * (x - origin_), b = axes_.transpose() * linear_;
  const auto at = [&](double l) -> Vector3 {
    return (p - l * b).array() / (1 + 2 * l * curves_.array());
  };
  const auto f = [&](double l, double& slope) {
    const Vector3 y = at(l);
    const Vector3 g = 2 * curves_.cwiseProduct(y) + b;
    slope = -(g.array().square() / (1 + 2 * l * curves_.array())).sum();
    return (curves_.array() * y.array().square()).sum() + b.dot(y) + constant_;
  };
  const double most = curves_.maxCoeff(), least = curves_.minCoeff();
  double low = most > 0 ? -1 / (2 * most) : -infinity;
  double high = least < 0 ? -1 / (2 * least) : infinity;

  double slope, l = 0, value = f(0, slope);
  for (int step = 0; step < 200; ++step) {
    if (value == 0 || slope == 0) break;
    (value > 0 ? low : high) = l;
    double next = l - value / slope;
    if (next == l) break;
    if (!(next > low && next < high)) {
      if (std::isinf(low) || std::isinf(high)) return no_point();
      next = (low + high) / 2;
    }
    const double moved = std::abs(next - l);
    l = next;
    value = f(l, slope);
    if (moved <= 1e-16 * std::abs(l)) break;
  }
  const Vector3 y = at(l);
  const Vector3 g = 2 * curves_.cwiseProduct(y) + b;
  const double size = g.norm() * (y.norm() + (p - y).norm()) + std::abs(constant_);
  return y.allFinite() && std::abs(value) <= 1e-9 * size ? Vector3(origin_ + axes_ * y)
                                                         : no_point();
}

double Quadric::signed_distance(const Vector3& x) const {
  const double distance = (x - foot(x)).norm();
  return value(x) < 0 ? -distance : distance;
}

Values Quadric::numbers() const {
  return {{"matrix", Eigen::MatrixXd(matrix_)},
          {"linear", linear()},
          {"constant", constant()},
          {"origin", origin_},
          {"gradient", linear_},
          {"value", constant_}};
}

std::unique_ptr<Mirror> Quadric::transformed(double scale, const Matrix3& rotation,
                                             const Vector3& translation) const {
  // f((R'(x - t)) / s), times s^2.
  return std::make_unique<Quadric>(rotation * matrix_ * rotation.transpose(),
                                   scale * (rotation * origin_) + translation,
                                   scale * (rotation * linear_), scale * scale * constant_);
}

Mesh Quadric::mesh_over(PointsView object, int resolution, const Context& context) const {
  const Points feet = finite_rows(project(object, context.stage(0, 0.3)));
  if (feet.rows() == 0)
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has a foot on this quadric");
  return surface_net(
      feet, resolution, [this](const Vector3& x) { return value(x); },
      [this](const Vector3& x) { return foot(x); }, context);
}

}  // namespace symsurf
