#pragma once

#include <symsurf/mirrors.h>

#include "cloud/principal_frame.h"

namespace symsurf {

class PlaneStep;

/// A plane while it is searched for: normal . x + offset = 0 in the principal frame, |normal| = 1.
struct UnitPlane {
  using Step = PlaneStep;

  Vector3 normal = Vector3::UnitX();
  double offset = 0;

  double distance(const Vector3& x) const { return normal.dot(x) + offset; }
  Vector3 reflect(const Vector3& x) const { return x - 2 * distance(x) * normal; }
  Vector3 reflect_direction(const Vector3& v) const { return v - 2 * normal.dot(v) * normal; }
  Vector3 reflect_direction(const Vector3& /*x*/, const Vector3& v) const {
    return reflect_direction(v);
  }
};

inline UnitPlane in_frame(const Plane& plane, const PrincipalFrame& frame) {
  return {frame.axes.transpose() * plane.normal(),
          plane.signed_distance(frame.centroid) / frame.size};
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
