#pragma once

#include <Eigen/Dense>

#include "unit_plane.h"

namespace symsurf {

/// One Gauss-Newton step for a plane: sums weighted squared gaps between images and partners in
/// their metrics, linear in a tilt of the normal (two numbers) and a shift of the offset.
class PlaneStep {
 public:
  explicit PlaneStep(const UnitPlane& plane)
      : plane_(plane), u_(plane.normal.unitOrthogonal()), v_(plane.normal.cross(u_)) {}

  void add(const Vector3& x, const Vector3& gap, const Matrix3& metric, double weight) {
    const double l = plane_.distance(x);
    Matrix3 slope;
    slope.col(0) = -2 * (u_.dot(x) * plane_.normal + l * u_);
    slope.col(1) = -2 * (v_.dot(x) * plane_.normal + l * v_);
    slope.col(2) = -2 * plane_.normal;
    const Matrix3 weighted = weight * metric * slope;
    hessian_.noalias() += slope.transpose() * weighted;
    gradient_.noalias() += weighted.transpose() * gap;
  }

  /// The plane after the step, and how far it moved; the same plane where nothing holds it.
  UnitPlane taken(double* moved = nullptr) const {
    Matrix3 damped = hessian_;
    damped.diagonal().array() += 1e-12 * hessian_.trace() + 1e-300;
    const Vector3 change = damped.ldlt().solve(-gradient_);
    if (moved) *moved = change.norm();
    UnitPlane next = plane_;
    next.normal = (plane_.normal + change[0] * u_ + change[1] * v_);
    const double length = next.normal.norm();
    next.normal /= length;
    next.offset = (plane_.offset + change[2]) / length;
    return next;
  }

 private:
  UnitPlane plane_;
  Vector3 u_, v_;
  Matrix3 hessian_ = Matrix3::Zero();
  Vector3 gradient_ = Vector3::Zero();
};

}  // namespace symsurf
