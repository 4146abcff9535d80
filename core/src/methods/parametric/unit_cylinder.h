#pragma once

#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

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

}  // namespace symsurf
