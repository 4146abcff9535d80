#pragma once

#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloud/principal_frame.h"

namespace symsurf {

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

}  // namespace symsurf
