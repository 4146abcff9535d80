#pragma once

#include <Eigen/Dense>

#include "cloud/unit_plane.h"
#include "score/correspondence.h"

namespace symsurf {

/// One Gauss-Newton step for a plane: sums weighted squared gaps between images and partners in
/// their metrics, linear in a tilt of the normal (two numbers) and a shift of the offset.
class PlaneStep {
 public:
  explicit PlaneStep(const UnitPlane& plane)
      : plane_(plane), u_(plane.normal.unitOrthogonal()), v_(plane.normal.cross(u_)) {}

  // The image's slopes are -2 (a n + l u), -2 (b n + l v) and -2 n, with a, b, l the coordinates of
  // x along u, v and n: their products with one another and with any vector are short.
  void add(const Vector3& x, const Vector3& gap, const Metric& metric, double weight) {
    const double a = u_.dot(x), b = v_.dot(x), l = plane_.distance(x);
    const auto along_slopes = [&](const Vector3& y) -> Vector3 {
      const double n = plane_.normal.dot(y);
      return {a * n + l * u_.dot(y), b * n + l * v_.dot(y), n};
    };
    const Vector3 off = along_slopes(metric.normal), pulled = along_slopes(gap);
    Matrix3 slopes;
    slopes << a * a + l * l, a * b, a, a * b, b * b + l * l, b, a, b, 1;
    const double all = 4 * weight * metric.isotropic, surface = 4 * weight * metric.off_surface;
    hessian_ += all * slopes + surface * off * off.transpose();
    gradient_ -= (all * pulled + surface * metric.normal.dot(gap) * off) / 2;
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
