#pragma once

#include <symsurf/quadric.h>

#include <vector>

#include "optics/light_path.h"

namespace symsurf {

/// The points at which a quadric reflects light to an eye, by a search in one dimension.
///
/// There the surface's normal n lies in one plane with source and eye. That holds on a curve, the
/// intersection of the mirror with a second quadric (Miguel et al.). A plane through source and
/// eye with the normal m holds two points of it: those of the mirror on the line where n . m = 0,
/// which is linear in the point. So the angle of the plane numbers the curve, and the law of
/// reflection, with w the tangent in the plane,
///
///   (s - x) . w (e - x) . n + (e - x) . w (s - x) . n = 0,
///
/// is searched for its changes of sign. A plane through both ends that mirrors the quadric holds a
/// conic of the curve, which is searched likewise, by the angle of a line through the eye.
class QuadricReflection {
 public:
  QuadricReflection(const Quadric& quadric, const Vector3& eye);

  /// In no order; some twice.
  std::vector<SurfacePoint> operator()(const Vector3& source) const;

 private:
  Vector3 eye_;
  Matrix3 axes_;  // eigenvectors, columns
  // f = y . (curves * y) + linear . y + constant in the frame of the axes about the eye.
  Vector3 curves_, linear_;
  double constant_;
};

}  // namespace symsurf
