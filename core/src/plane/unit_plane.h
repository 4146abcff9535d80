#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// A plane while it is searched for: normal . x + offset = 0 in the principal frame, |normal| = 1.
struct UnitPlane {
  Vector3 normal = Vector3::UnitX();
  double offset = 0;

  double distance(const Vector3& x) const { return normal.dot(x) + offset; }
  Vector3 reflect(const Vector3& x) const { return x - 2 * distance(x) * normal; }
  Vector3 reflect_direction(const Vector3& v) const { return v - 2 * normal.dot(v) * normal; }
};

}  // namespace symsurf
