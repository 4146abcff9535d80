#pragma once

#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/linear_algebra.h"
#include "cloud/principal_frame.h"
#include "pairing/correspondence.h"

namespace symsurf {

class CylinderStep;

/// A circular cylinder while it is searched for, in the principal frame; |axis| = 1.
struct UnitCylinder {
  using Step = CylinderStep;

  /// What is added to the point and to the axis, along either side each, and to the radius.
  using Change = Eigen::Vector<double, 5>;

  Vector3 point = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();
  double radius = 1;

  Vector3 from_axis(const Vector3& x) const {
    const Vector3 d = x - point;
    return d - d.dot(axis) * axis;
  }
  double distance(const Vector3& x) const { return from_axis(x).norm() - radius; }

  /// NaN where x has no image.
  Vector3 reflect(const Vector3& x) const {
    const Vector3 v = from_axis(x);
    const double length = v.norm();
    if (!(length > 1e-9) || length > 2 * radius)
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    return x + 2 * (radius / length - 1) * v;
  }

  /// The unit normal at the image of a surface through x with normal n: tangents around the axis
  /// stretch by 2r / |v| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& n) const {
    const Vector3 v = from_axis(x);
    const double length = v.norm();
    const Vector3 u = v / length;
    const double stretch = std::max(2 * radius / length - 1, 1e-6);
    const Vector3 upright = u.dot(n) * u, lengthwise = axis.dot(n) * axis;
    return ((n - upright - lengthwise) / stretch + lengthwise - upright).normalized();
  }

  /// Of the axis.
  Vector3 nearest_to_origin() const { return point - point.dot(axis) * axis; }

  /// The axis tilts about its point nearest to the origin.
  UnitCylinder changed(const Change& by) const {
    return {nearest_to_origin() + by[0] * side(0) + by[1] * side(1),
            (axis + by[2] * side(0) + by[3] * side(1)).normalized(),
            std::max(radius + by[4], 1e-3)};
  }

  /// Unit vectors across the axis.
  Vector3 side(int k) const {
    const Vector3 first = axis.unitOrthogonal();
    return k == 0 ? first : axis.cross(first);
  }
};

class SphereStep;

/// A sphere, or where its curvature is 0 a plane, while it is searched for, in the principal frame:
/// F(x) = k/2 |x - p|^2 + n . (x - p) = 0 through the point p with the unit normal n there. The
/// sign of k is the side it bends to (Pratt, Direct least-squares fitting of algebraic surfaces,
/// 1987).
struct UnitSphere {
  using Step = SphereStep;

  /// A shift along the normal, two tilts about the point, what is added to the curvature.
  using Change = Eigen::Vector4d;

  Vector3 point = Vector3::Zero(), normal = Vector3::UnitX();
  double curvature = 1;

  /// Neither is finite of a plane.
  double radius() const { return 1 / std::abs(curvature); }
  Vector3 centre() const { return point - normal / curvature; }

  /// Its length at x is the distance from the centre, in radii: 1 on the mirror.
  Vector3 gradient(const Vector3& x) const { return normal + curvature * (x - point); }

  double distance(const Vector3& x) const { return twice_distance(x, gradient(x).norm()) / 2; }

  /// NaN where x has no image.
  Vector3 reflect(const Vector3& x) const {
    const Vector3 up = gradient(x);
    const double length = up.norm();
    if (!(length > 1e-9) || length > 2)
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    return x - twice_distance(x, length) / length * up;
  }

  /// The unit normal at the image of a surface through x with normal v: tangents across the radius
  /// stretch by 2 / |gradient| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& v) const {
    const Vector3 up = gradient(x);
    const double length = up.norm(), stretch = std::max(2 / length - 1, 1e-6);
    const Vector3 u = up / length;
    const double along = u.dot(v);
    return ((v - along * u) / stretch - along * u).normalized();
  }

  UnitSphere changed(const Change& by) const {
    return {point + by[0] * normal, (normal + by[1] * side(0) + by[2] * side(1)).normalized(),
            curvature + by[3]};
  }

  /// Unit vectors across the normal.
  Vector3 side(int k) const {
    const Vector3 first = normal.unitOrthogonal();
    return k == 0 ? first : normal.cross(first);
  }

 private:
  friend class SphereStep;

  // 4 F / (1 + |gradient|), which loses no digits where the curvature vanishes.
  double twice_distance(const Vector3& x, double length) const {
    const Vector3 off = x - point;
    return 4 * (curvature / 2 * off.squaredNorm() + normal.dot(off)) / (1 + length);
  }
};

inline Sphere in_input_units(const UnitSphere& sphere, const PrincipalFrame& frame) {
  return {frame.from_frame(sphere.centre()), frame.size * sphere.radius()};
}

/// How a mirror next to a plane bends, in the principal frame: to the second order its height over
/// the plane through the point is e' C e / 2, e the offset along the plane.
struct PlaneBend {
  Vector3 point, normal;
  Vector3 most_bent;               ///< the principal direction of the greater curvature
  double greater = 0, lesser = 0;  ///< principal curvatures, by amount; to the normal's side

  UnitSphere sphere() const { return {point, normal, -(greater + lesser) / 2}; }
  UnitCylinder cylinder() const {
    return {point + normal / greater, normal.cross(most_bent), 1 / std::abs(greater)};
  }
};

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
    const Vector3 change = -solved(damped, gradient_);
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
