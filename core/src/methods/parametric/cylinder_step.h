#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "base/semidefinite_solve.h"
#include "methods/parametric/unit_cylinder.h"

namespace symsurf {

/// One Gauss-Newton step for a cylinder: the point moves and the axis tilts in two directions each,
/// the radius grows. x' = x - 2 (1 - r / |v|) v with v = (I - a a') (x - p).
class CylinderStep {
 public:
  explicit CylinderStep(const UnitCylinder& cylinder)
      : cylinder_(cylinder), sides_{cylinder.side(0), cylinder.side(1)} {
    // The axis tilts about the point nearest to the cloud's middle.
    cylinder_.point = cylinder_.nearest_to_origin();
  }

  void add(const Vector3& x, const Vector3& gap, const Matrix3& metric, double weight) {
    const Vector3 d = x - cylinder_.point, v = cylinder_.from_axis(x);
    const double length = v.norm(), bend = cylinder_.radius / length;
    const Vector3 u = v / length;
    const Matrix3 by_v = -2 * ((1 - bend) * Matrix3::Identity() + bend * u * u.transpose());
    Eigen::Matrix<double, 3, 5> slope;
    for (int k = 0; k < 2; ++k) {
      slope.col(k) = by_v * -sides_[k];
      slope.col(2 + k) =
          by_v * (-d.dot(sides_[k]) * cylinder_.axis - d.dot(cylinder_.axis) * sides_[k]);
    }
    slope.col(4) = 2 * u;
    const Eigen::Matrix<double, 3, 5> weighted = weight * metric * slope;
    hessian_.noalias() += slope.transpose() * weighted;
    gradient_.noalias() += weighted.transpose() * gap;
  }

  const Eigen::Matrix<double, 5, 5>& hessian() const { return hessian_; }

  /// The cylinder after the step, and how far it moved; the same one where nothing holds it.
  UnitCylinder taken(double* moved = nullptr) const {
    UnitCylinder::Change change =
        solved<5>(hessian_ + Hessian(damping() * Hessian::Identity()), -gradient_);
    // Wide cylinders may slide along their radius, but none turns inside out.
    const double longest = std::min(0.5 * cylinder_.radius, 1.0);
    if (change.norm() > longest) change *= longest / change.norm();
    if (moved) *moved = change.norm();
    return cylinder_.changed(change);
  }

 private:
  using Hessian = Eigen::Matrix<double, 5, 5>;

  double damping() const { return 1e-13 * hessian_.trace() + 1e-300; }

  UnitCylinder cylinder_;
  Vector3 sides_[2];
  Hessian hessian_ = Hessian::Zero();
  UnitCylinder::Change gradient_ = UnitCylinder::Change::Zero();
};

}  // namespace symsurf
