#pragma once

#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <utility>

namespace symsurf {

/// The coordinate frame in which methods compute (principal component analysis): the centroid at 0,
/// the principal axes along x, y, z, longest first, the bounding box's diagonal 1. It moves with
/// the cloud, so results do not depend on unit or pose. The axes' signs follow the third moments,
/// or where these are but rounding make the largest component positive; it may be left-handed.
struct PrincipalFrame {
  Vector3 centroid = Vector3::Zero();
  Matrix3 axes = Matrix3::Identity();  ///< columns, in input coordinates
  double size = 1;                     ///< input units a unit of the frame
  Vector3 variance = Vector3::Zero();  ///< along the axes, in input units squared
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();  ///< the box, in the frame

  Vector3 to_frame(const Vector3& x) const;
  Points to_frame(PointsView points, const Context& context) const;
  Vector3 from_frame(const Vector3& x) const;

  /// The same axes with another unit, in input units.
  PrincipalFrame with_size(double other) const;
};

/// Of at least one point; all must be finite. A cloud of equal points gets a size of 0.
PrincipalFrame principal_frame(PointsView points, const Context& context);

/// A plane while it is searched for: normal . x + offset = 0 in the principal frame, |normal| = 1.
struct UnitPlane {
  /// Two tilts of the normal, along unit vectors across it, and what is added to the offset.
  using Change = Vector3;

  Vector3 normal = Vector3::UnitX();
  double offset = 0;

  double distance(const Vector3& x) const { return normal.dot(x) + offset; }
  Vector3 reflect(const Vector3& x) const { return x - 2 * distance(x) * normal; }
  Vector3 reflect_direction(const Vector3& v) const { return v - 2 * normal.dot(v) * normal; }
  Vector3 reflect_direction(const Vector3& /*x*/, const Vector3& v) const {
    return reflect_direction(v);
  }

  /// By how much each number moves the image of x.
  Matrix3 slopes(const Vector3& x) const {
    const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const double l = distance(x);
    Matrix3 slopes;
    slopes << -2 * (u.dot(x) * normal + l * u), -2 * (v.dot(x) * normal + l * v), -2 * normal;
    return slopes;
  }

  /// Changed, and by how much.
  std::pair<UnitPlane, double> stepped(const Change& by) const {
    const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vector3 tilted = normal + by[0] * u + by[1] * v;
    const double length = tilted.norm();
    return {{tilted / length, (offset + by[2]) / length}, by.norm()};
  }
  void follow(const UnitPlane& moved) { *this = moved; }
  static constexpr double ridge = 1e-13;  // rounding
  static constexpr bool is_affine = true;
};

/// The mirror's tangent plane at the foot of the centroid: of a plane itself.
inline UnitPlane in_frame(const Mirror& mirror, const PrincipalFrame& frame) {
  const Foot foot = *mirror.at(frame.centroid);
  return {frame.axes.transpose() * foot.normal, foot.distance / frame.size};
}

inline Plane in_input_units(const UnitPlane& plane, const PrincipalFrame& frame) {
  // The sign by a direction that no normal along axes and diagonals is orthogonal to: alike shapes
  // in alike poses get alike normals.
  const Vector3 unsigned_normal = frame.axes * plane.normal;
  const double sign = unsigned_normal.dot(Vector3(4, 2, 1)) < 0 ? -1 : 1;
  const Vector3 normal = sign * unsigned_normal;
  return Plane(normal, sign * frame.size * plane.offset - normal.dot(frame.centroid));
}

}  // namespace symsurf
