#pragma once

#include <symsurf/types.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace symsurf {

class SphereStep;

/// A sphere while it is searched for, in the principal frame.
struct UnitSphere {
  using Step = SphereStep;

  Vector3 centre = Vector3::Zero();
  double radius = 1;

  double distance(const Vector3& x) const { return (x - centre).norm() - radius; }

  /// NaN where x has no image.
  Vector3 reflect(const Vector3& x) const {
    const Vector3 u = x - centre;
    const double length = u.norm();
    if (!(length > 1e-9) || length > 2 * radius)
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    return centre + (2 * radius / length - 1) * u;
  }

  /// The unit normal at the image of a sheet through x with normal n: tangents across the radius
  /// stretch by 2r / |u| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& n) const {
    const Vector3 u = (x - centre).normalized();
    const double stretch = std::max(2 * radius / (x - centre).norm() - 1, 1e-6);
    const double along = u.dot(n);
    return ((n - along * u) / stretch - along * u).normalized();
  }
};

/// One Gauss-Newton step for a sphere: sums weighted squared gaps between images and partners in
/// their metrics. x' = 2c - x + 2r u, so dx'/dc = 2I - 2r/|x - c| (I - u u') and dx'/dr = 2u.
class SphereStep {
 public:
  explicit SphereStep(const UnitSphere& sphere) : sphere_(sphere) {}

  void add(const Vector3& x, const Vector3& gap, const Matrix3& metric, double weight) {
    const Vector3 arm = x - sphere_.centre;
    const double length = arm.norm();
    const Vector3 u = arm / length;
    const double bend = 2 * sphere_.radius / length;
    Eigen::Matrix<double, 3, 4> slope;
    slope.leftCols<3>() = bend * u * u.transpose();
    slope.leftCols<3>().diagonal().array() += 2 - bend;
    slope.col(3) = 2 * u;
    const Eigen::Matrix<double, 3, 4> weighted = weight * metric * slope;
    hessian_.noalias() += slope.transpose() * weighted;
    gradient_.noalias() += weighted.transpose() * gap;
  }

  const Eigen::Matrix4d& hessian() const { return hessian_; }

  /// The sphere after the step, and how far it moved; the same sphere where nothing holds it.
  UnitSphere taken(double* moved = nullptr) const {
    Eigen::Matrix4d damped = hessian_;
    damped.diagonal().array() += 1e-13 * hessian_.trace() + 1e-300;
    Eigen::Vector4d change = damped.ldlt().solve(-gradient_);
    // Far spheres may slide along their radius, but none turns inside out.
    const double longest = 0.5 * sphere_.radius;
    if (change.norm() > longest) change *= longest / change.norm();
    if (moved) *moved = change.norm();
    return {sphere_.centre + change.head<3>(), std::max(sphere_.radius + change[3], 1e-3)};
  }

 private:
  UnitSphere sphere_;
  Eigen::Matrix4d hessian_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient_ = Eigen::Vector4d::Zero();
};

}  // namespace symsurf
