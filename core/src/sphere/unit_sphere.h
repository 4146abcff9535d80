#pragma once

#include <symsurf/principal_frame.h>
#include <symsurf/sphere.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace symsurf {

class SphereStep;

/// A sphere, or where its curvature is 0 a plane, while it is searched for, in the principal frame:
/// F(x) = k/2 |x - p|^2 + n . (x - p) = 0 through the point p with the unit normal n there. Of
/// either sign, k tells to which side it bends. It is a |x|^2 + b . x + c with |b|^2 - 4 a c = 1
/// (Pratt, Direct least-squares fitting of algebraic surfaces, 1987): a = k/2, b = n - k p,
/// c = k/2 |p|^2 - n . p.
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

  /// The unit normal at the image of a sheet through x with normal v: tangents across the radius
  /// stretch by 2 / |gradient| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& v) const {
    const Vector3 up = gradient(x);
    const double length = up.norm(), stretch = std::max(2 / length - 1, 1e-6);
    const Vector3 u = up / length;
    const double along = u.dot(v);
    return ((v - along * u) / stretch - along * u).normalized();
  }

  /// (a, b, c) as above.
  Eigen::Vector<double, 5> coefficients() const {
    Eigen::Vector<double, 5> abc;
    const Vector3 b = normal - curvature * point;
    abc << curvature / 2, b, curvature / 2 * point.squaredNorm() - normal.dot(point);
    return abc;
  }

  /// Of (a, b, c) of any length, |b|^2 > 4 a c; its point is the one nearest to the origin.
  static UnitSphere of(Eigen::Vector<double, 5> abc) {
    abc /= std::sqrt(abc.segment<3>(1).squaredNorm() - 4 * abc[0] * abc[4]);
    const Vector3 b = abc.segment<3>(1);
    const double length = b.norm(), distance = 2 * abc[4] / (1 + length);
    const Vector3 up = length > 0 ? Vector3(b / length) : Vector3(Vector3::UnitX());
    return {-distance * up, length < 2 * abc[0] * distance ? Vector3(-up) : up, 2 * abc[0]};
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
    UnitSphere::Change change = damped.ldlt().solve(-gradient_);
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

inline Sphere in_input_units(const UnitSphere& sphere, const PrincipalFrame& frame) {
  return {frame.leave(sphere.centre()), frame.size * sphere.radius()};
}

}  // namespace symsurf
