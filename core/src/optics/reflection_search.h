#pragma once

#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <functional>
#include <vector>

#include "optics/light_path.h"

namespace symsurf {

/// A function of an angle: constant + c1 cos + s1 sin + c2 cos 2 + s2 sin 2.
struct TurnPolynomial {
  double constant, c1, s1, c2, s2;

  /// Its zeros within one turn, in radians: at most four, the roots of a quartic in the tangent of
  /// half the angle. None where it is zero everywhere.
  std::vector<double> zeros() const;
};

/// The points of the unit circle, as unit vectors, at which light is reflected from a source to an
/// eye in its plane (Alhazen's problem): at most four.
///
/// With complex numbers s, e and z on the circle, s / z - 1 and e / z - 1 are where they are seen
/// from z along the normal. Light is reflected where these have opposite angles, so that their
/// product is real and positive: Im(s e / z^2 - (s + e) / z) = 0.
std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye);

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

/// The points at which a mirror without a formula reflects light to an eye: Newton's steps from the
/// triangles of a mesh over its footprint on which the path length, whose gradient is interpolated,
/// is stationary or nearly so.
class FootprintReflection {
 public:
  /// Height fields, free forms and surface mirrors. Throws InvalidInput where there is no
  /// footprint, nor nodes or patches to stand for it.
  FootprintReflection(const Mirror& mirror, const Vector3& eye);

  /// In no order; some twice.
  std::vector<SurfacePoint> operator()(const Vector3& source) const;

 private:
  // The foot of x, or the surface's point over x, and the normal there.
  using Tangent = std::function<bool(const Vector3& x, Vector3& foot, Vector3& normal)>;

  static Tangent tangent_of(const Mirror& mirror);
  bool at(const Vector3& x, SurfacePoint& found) const;

  Vector3 eye_;
  Tangent tangent_;
  std::vector<Vector3> feet_, normals_;  // of the mesh's vertices
  Triangles triangles_;
  double step_;  // over which normals are compared
};

}  // namespace symsurf
