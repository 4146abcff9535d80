#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/semidefinite_solve.h"
#include "methods/parametric/unit_sphere.h"

namespace symsurf {

/// One Gauss-Newton step for a sphere: sums weighted squared gaps between images and partners in
/// their metrics. A change of F by f moves the image x' = 2 q - x, q the mirror's point nearest to
/// x, d away, u the direction and g the length of the gradient at x, by
/// -2 (f(q) u + d / g (I - u u') grad f(q)).
class SphereStep {
 public:
  explicit SphereStep(const UnitSphere& sphere)
      : sphere_(sphere), sides_{sphere.side(0), sphere.side(1)} {}

  void add(const Vector3& x, const Vector3& gap, const Matrix3& metric, double weight) {
    const Vector3 up = sphere_.gradient(x), n = sphere_.normal;
    const double g = up.norm(), d = sphere_.twice_distance(x, g) / 2, k = sphere_.curvature;
    const Vector3 u = up / g, y = x - d * u - sphere_.point;
    Eigen::Matrix<double, 3, 4> slope;
    const auto moved = [&](double f, const Vector3& rise) -> Vector3 {
      return -2 * ((f - d / g * u.dot(rise)) * u + d / g * rise);
    };
    slope.col(0) = moved(-1 - k * n.dot(y), -k * n);
    slope.col(1) = moved(sides_[0].dot(y), sides_[0]);
    slope.col(2) = moved(sides_[1].dot(y), sides_[1]);
    slope.col(3) = moved(y.squaredNorm() / 2, y);
    const Eigen::Matrix<double, 3, 4> weighted = weight * metric * slope;
    hessian_.noalias() += slope.transpose() * weighted;
    gradient_.noalias() += weighted.transpose() * gap;
  }

  const Eigen::Matrix4d& hessian() const { return hessian_; }

  /// The sphere after the step, and how far it moved; the same sphere where nothing holds it.
  UnitSphere taken(double* moved = nullptr) const {
    Eigen::Matrix4d damped = hessian_;
    damped.diagonal().array() += 1e-13 * hessian_.trace() + 1e-300;
    UnitSphere::Change change = solved<4>(damped, -gradient_);
    // Flat spheres may bend to the other side, but small ones do not turn inside out.
    const double size = 1 / std::max(std::abs(sphere_.curvature), 1.0);
    const double length =
        Eigen::Vector4d(change[0], size * change[1], size * change[2], size * size * change[3])
            .norm();
    const double longest = 0.5 * size;
    if (length > longest) change *= longest / length;
    if (moved) *moved = std::min(length, longest);
    return sphere_.changed(change);
  }

 private:
  UnitSphere sphere_;
  Vector3 sides_[2];
  Eigen::Matrix4d hessian_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient_ = Eigen::Vector4d::Zero();
};

}  // namespace symsurf
