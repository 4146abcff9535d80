#pragma once

#include <symsurf/mirror.h>

#include <memory>

namespace symsurf {

/// Coordinates along a mirror, and the tangent plane they are laid out in.
class Chart {
 public:
  virtual ~Chart() = default;

  const Vector3& origin() const { return origin_; }
  /// Columns: the two directions of the coordinates and the normal.
  const Matrix3& axes() const { return axes_; }

  /// From a point of the mirror to its coordinates.
  virtual Eigen::Vector2d flatten(const Vector3& foot) const = 0;
  /// The point of the mirror at the coordinates, and the normal there; false beyond the mirror.
  virtual bool lift(const Eigen::Vector2d& at, Vector3& foot, Vector3& normal) const = 0;

 protected:
  Vector3 origin_;
  Matrix3 axes_;
};

/// Laid out over the mirror's footprint or, without one, over the object.
/// Throws InvalidInput when nothing of that has a foot.
std::unique_ptr<Chart> chart_of(const Mirror& mirror, PointsView object);

/// The mirror's normal at the foot of x, towards where signed_distance is positive; false without.
bool foot_and_normal(const Mirror& mirror, const Vector3& x, Vector3& foot, Vector3& normal);

}  // namespace symsurf
