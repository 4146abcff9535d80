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

/// Laid out over an object that lies about the origin and is 1 long. The mirror must outlive it.
/// Throws InvalidInput when nothing of the object has a foot.
std::unique_ptr<Chart> chart_of(const Mirror& mirror, PointsView object);

}  // namespace symsurf
