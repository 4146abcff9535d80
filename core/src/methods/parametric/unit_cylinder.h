#pragma once

#include <symsurf/types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace symsurf {

class CylinderStep;

/// A circular cylinder while it is searched for, in the principal frame; |axis| = 1.
struct UnitCylinder {
  using Step = CylinderStep;

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
};

}  // namespace symsurf
